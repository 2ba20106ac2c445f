// SPDX-License-Identifier: MIT
#include "papilla/param/projections.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "papilla/core/error.hpp"
#include "papilla/param/measure.hpp"
#include "papilla_test/shapes.hpp"
#include "support/formula_meshes.hpp"

namespace papilla {
namespace {

TEST(Planar, TiltedPlaneIsKept) {
  TriangleMesh mesh = test::plane(30, 20, 6, 4);
  for (Vec3& p : mesh.positions) p = {p.x, 0.6 * p.y, 0.8 * p.y};
  const ProjectionResult r = flatten_planar(mesh);
  EXPECT_NEAR(r.direction.y, -0.8, 1e-12);
  EXPECT_NEAR(r.direction.z, 0.6, 1e-12);
  EXPECT_EQ(r.turned_over, 0u);
  EXPECT_EQ(r.flattening.charts.count, 1u);
  EXPECT_NEAR(measure_distortion(mesh, r.flattening.uv).symmetric_dirichlet.max, 4, 1e-9);
}

TEST(Planar, BackOfACubeIsNotMirrored) {
  const TriangleMesh mesh = test::cube(5);
  PlanarOptions options;
  options.direction = Vec3{0, 0, 2};
  const ProjectionResult r = flatten_planar(mesh, options);
  EXPECT_EQ(r.turned_over, 2u);
  const DistortionReport d = measure_distortion(mesh, r.flattening.uv);
  EXPECT_EQ(d.mirrored_charts, 0u);
  EXPECT_EQ(d.flipped, 0u);
  EXPECT_EQ(d.degenerate_uv, 8u);  // the four walls are seen edge-on
}

TEST(Planar, KnownStretch) {
  // A plane at 60° to the projection keeps one direction and halves the other: σ = 1, 1/2 up to the common scale.
  TriangleMesh mesh = test::plane(30, 20, 6, 4);
  for (Vec3& p : mesh.positions) p = {p.x, 0.5 * p.y, std::sqrt(0.75) * p.y};
  PlanarOptions options;
  options.direction = Vec3{0, 0, 1};
  const DistortionReport d = measure_distortion(mesh, flatten_planar(mesh, options).flattening.uv);
  EXPECT_NEAR(d.conformal.mean, 2, 1e-9);
}

TEST(Intermediate, CylinderOnItselfIsAnIsometry) {
  const TriangleMesh mesh = test::cylinder(10, 30, 64, 12);
  IntermediateOptions options;
  options.shape = IntermediateShape::cylinder;
  for (const IntermediateRule rule : {IntermediateRule::intermediate_normal, IntermediateRule::object_normal}) {
    options.rule = rule;
    const ProjectionResult r = flatten_intermediate(mesh, options);
    EXPECT_EQ(r.flattening.charts.count, 1u);
    EXPECT_EQ(r.turned_over, 0u);
    // The polygon's sides are shorter than their arcs.
    EXPECT_NEAR(measure_distortion(mesh, r.flattening.uv).symmetric_dirichlet.max, 4, 1e-4);
  }
}

TEST(Intermediate, SphereOnItselfKeepsTheEquator) {
  const TriangleMesh mesh = test::uv_sphere(10, 64, 128);
  IntermediateOptions options;
  options.shape = IntermediateShape::sphere;
  for (const IntermediateRule rule :
       {IntermediateRule::intermediate_normal, IntermediateRule::object_normal, IntermediateRule::object_centroid}) {
    options.rule = rule;
    const ProjectionResult r = flatten_intermediate(mesh, options);
    EXPECT_EQ(r.turned_over, 0u);
    double height = 0, width = 0;
    for (const Vec2 p : r.flattening.uv.values) height = std::max(height, p.y), width = std::max(width, p.x);
    EXPECT_NEAR(height, 5 * std::numbers::pi, 1e-6);
    EXPECT_NEAR(width, 10 * std::numbers::pi, 0.5);
    const DistortionReport d = measure_distortion(mesh, r.flattening.uv);
    EXPECT_EQ(d.flipped, 0u);
    EXPECT_EQ(d.mirrored_charts, 0u);
  }
}

TEST(Intermediate, BoxOnACubeIsAnIsometry) {
  const TriangleMesh mesh = test::cube(4);
  const ProjectionResult r = flatten_intermediate(mesh);
  EXPECT_EQ(r.flattening.charts.count, 6u);
  EXPECT_NEAR(measure_distortion(mesh, r.flattening.uv).symmetric_dirichlet.max, 4, 1e-9);
}

TEST(Intermediate, EveryShapeAndRuleGivesFiniteUvOfTheRightHand) {
  const TriangleMesh mesh = test::torus(30, 10, 24, 12);
  for (const auto shape :
       {IntermediateShape::sphere, IntermediateShape::cylinder, IntermediateShape::cone, IntermediateShape::box})
    for (const auto rule : {IntermediateRule::reflected_ray, IntermediateRule::object_normal,
                            IntermediateRule::object_centroid, IntermediateRule::intermediate_normal})
      for (const UpAxis up : {UpAxis::y, UpAxis::z}) {
        IntermediateOptions options;
        options.shape = shape, options.rule = rule, options.up = up;
        const ProjectionResult r = flatten_intermediate(mesh, options);
        ASSERT_EQ(r.flattening.uv.indices.size(), mesh.triangles.size());
        for (const Vec2 p : r.flattening.uv.values) ASSERT_TRUE(is_finite(p));
        EXPECT_EQ(measure_distortion(mesh, r.flattening.uv).mirrored_charts, 0u);
      }
}

TEST(Environment, LooksBackWhereTheSurfaceFacesTheEye) {
  const TriangleMesh mesh = test::uv_sphere(10, 32, 64);
  EnvironmentOptions options;
  options.eye = Vec3{0, -1e6, 0};
  const CornerAttribute<Vec2> uv = environment_uv(mesh, options);
  ASSERT_EQ(uv.indices.size(), mesh.triangles.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    EXPECT_GE(uv.values[v].x, 0);
    EXPECT_LE(uv.values[v].x, 1);
    const Vec3 n = normalized(mesh.positions[v]);
    if (n.y > -0.2) continue;  // at the outline the map is singular
    // For a far eye, u - 1/2 and v - 1/2 are half the components of the normal.
    EXPECT_NEAR(uv.values[v].x, 0.5 + 0.5 * n.x, 0.02);
    EXPECT_NEAR(uv.values[v].y, 0.5 + 0.5 * n.z, 0.02);
  }
}

TEST(Projections, BadInputIsNamed) {
  TriangleMesh mesh = test::cube(1);
  PlanarOptions planar;
  planar.direction = Vec3{};
  EXPECT_THROW(flatten_planar(mesh, planar), InvalidInput);
  IntermediateOptions intermediate;
  intermediate.eye = Vec3{0, std::nan(""), 0};
  EXPECT_THROW(flatten_intermediate(mesh, intermediate), InvalidInput);
  mesh.positions[0].x = std::numeric_limits<double>::infinity();
  EXPECT_THROW(flatten_planar(mesh), InvalidInput);
  EXPECT_THROW(environment_uv(mesh), InvalidInput);
  EXPECT_TRUE(flatten_planar({}).flattening.uv.empty());
  EXPECT_TRUE(flatten_intermediate({}).flattening.uv.empty());
}

}  // namespace
}  // namespace papilla
