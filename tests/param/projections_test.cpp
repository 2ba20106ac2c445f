// SPDX-License-Identifier: MIT
#include "papilla/param/projections.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/meshing/mesh_bounds.hpp"
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
  // Turned over or not, v grows upwards, which is along y here.
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Triangle &v = mesh.triangles[t], &i = r.flattening.uv.indices[t];
      const Vec2 step = r.flattening.uv.values[i[(k + 1) % 3]] - r.flattening.uv.values[i[k]];
      EXPECT_NEAR(step.y, mesh.positions[v[(k + 1) % 3]].y - mesh.positions[v[k]].y, 1e-9);
    }
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

TEST(Intermediate, BoxHasUvWhereTheRayMeetsIt) {
  // A small tilted triangle inside of a cube of half extent 10, whose +x face all rules find: there u = y, v = z.
  TriangleMesh mesh = test::cube(20);
  const Bounds3 bounds = bounds_of(mesh);
  for (Vec3& p : mesh.positions) p = p - bounds.middle();
  const Vec3 n = normalized(Vec3{1, -0.2, 0.5}), a = normalized(cross(n, Vec3{0, 0, 1})), b = cross(n, a);
  const Vec3 middle{5, 1, 2};
  const auto first = static_cast<Index>(mesh.positions.size());
  const std::array<Vec3, 3> corners{middle + a, middle - 0.5 * a + b, middle - 0.5 * a - b};
  mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
  mesh.triangles.push_back({first, first + 1, first + 2});
  ASSERT_GT(dot(n, cross(corners[1] - corners[0], corners[2] - corners[0])), 0);
  const Vec3 eye{40, 1, 20};
  const auto expected = [&](IntermediateRule rule, Vec3 p) -> Vec2 {
    switch (rule) {
      case IntermediateRule::object_normal: return {p.y + (10 - p.x) / n.x * n.y, p.z + (10 - p.x) / n.x * n.z};
      case IntermediateRule::object_centroid: return {10 / p.x * p.y, 10 / p.x * p.z};
      case IntermediateRule::reflected_ray: {
        const Vec3 view = normalized(p - eye), r = view - 2 * dot(view, n) * n;
        return {p.y + (10 - p.x) / r.x * r.y, p.z + (10 - p.x) / r.x * r.z};
      }
      case IntermediateRule::intermediate_normal: break;
    }
    return {p.y, p.z};
  };
  std::vector<Vec2> of_first_corner;
  for (const auto rule : {IntermediateRule::reflected_ray, IntermediateRule::object_normal,
                          IntermediateRule::object_centroid, IntermediateRule::intermediate_normal}) {
    IntermediateOptions options;
    options.rule = rule;
    options.eye = eye;
    const CornerAttribute<Vec2> uv = flatten_intermediate(mesh, options).flattening.uv;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 own = uv.values[uv.indices.back()[k]], wanted = expected(rule, corners[k]);
      EXPECT_NEAR(own.x, wanted.x, 1e-9) << static_cast<int>(rule);
      EXPECT_NEAR(own.y, wanted.y, 1e-9) << static_cast<int>(rule);
    }
    of_first_corner.push_back(uv.values[uv.indices.back()[0]]);
  }
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_GT(norm(of_first_corner[i] - of_first_corner[j]), 0.1);
}

/// A cube of these half extents around 0, and a small triangle with a normal of its own within it: its three corners.
std::array<Vec3, 3> add_triangle(TriangleMesh& mesh, Vec3 half, Vec3 middle, Vec3 n) {
  const Bounds3 bounds = bounds_of(mesh);
  for (Vec3& p : mesh.positions) {
    const Vec3 q = p - bounds.middle();
    p = {std::copysign(half.x, q.x), std::copysign(half.y, q.y), std::copysign(half.z, q.z)};
  }
  const Vec3 a = normalized(cross(n, Vec3{0, 0, 1})), b = cross(n, a);
  const std::array<Vec3, 3> corners{middle + a, middle - 0.5 * a + b, middle - 0.5 * a - b};
  const auto first = static_cast<Index>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
  mesh.triangles.push_back({first, first + 1, first + 2});
  return corners;
}

/// In a box of 10 by 40 by 20 a ray from far along y that runs along x meets the face in x.
TEST(Intermediate, ABoxHasThreeSides) {
  TriangleMesh mesh = test::cube(2);
  const Vec3 n = normalized(Vec3{1, 0.3, 0.1});
  const auto corners = add_triangle(mesh, {5, 20, 10}, {0, 10, 2}, n);
  IntermediateOptions options;
  options.rule = IntermediateRule::object_normal;
  const CornerAttribute<Vec2> uv = flatten_intermediate(mesh, options).flattening.uv;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 own = uv.values[uv.indices.back()[k]];
    EXPECT_NEAR(own.x, corners[k].y + (5 - corners[k].x) / n.x * n.y, 1e-9);
    EXPECT_NEAR(own.y, corners[k].z + (5 - corners[k].x) / n.x * n.z, 1e-9);
  }
}

/// Around a part that is deeper than wide: its radius is half the depth.
TEST(Intermediate, ACylinderIsAsWideAsTheLongerSide) {
  TriangleMesh mesh = test::cube(2);
  const auto corners = add_triangle(mesh, {2, 15, 3}, {1, 4, 1}, {0, 1, 0});
  IntermediateOptions options;
  options.shape = IntermediateShape::cylinder;
  options.rule = IntermediateRule::intermediate_normal;
  const CornerAttribute<Vec2> uv = flatten_intermediate(mesh, options).flattening.uv;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 own = uv.values[uv.indices.back()[k]];
    EXPECT_NEAR(std::remainder(own.x / 15 - std::atan2(corners[k].x, -corners[k].y), 2 * std::numbers::pi), 0, 1e-9);
    EXPECT_NEAR(own.y, corners[k].z, 1e-9);
  }
}

/// The cone of radius R at the top and 2 R at the bottom: what uv says lies on the ray, whether that rises or falls.
TEST(Intermediate, RaysMeetTheConeWhereTheyAre) {
  for (const double rise : {0.7, -0.5}) {
    TriangleMesh mesh = test::cube(2);
    const Vec3 n = normalized(Vec3{1, -0.4, rise});
    const auto corners = add_triangle(mesh, {10, 8, 6}, {2, -1, 1}, n);
    IntermediateOptions options;
    options.shape = IntermediateShape::cone;
    options.rule = IntermediateRule::object_normal;
    const CornerAttribute<Vec2> uv = flatten_intermediate(mesh, options).flattening.uv;
    const double apex = 18, opening = std::atan2(1.5 * 10, apex);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 own = uv.values[uv.indices.back()[k]];
      const double longitude = std::atan2(own.x, -own.y) / std::sin(opening), across = norm(own);
      const double radius = across * std::sin(opening);
      const Vec3 q{radius * std::sin(longitude), -radius * std::cos(longitude), apex - across * std::cos(opening)};
      EXPECT_NEAR(norm(cross(q - corners[k], n)), 0, 1e-9) << rise;
      EXPECT_GT(dot(q - corners[k], n), 0);
    }
  }
}

TEST(Intermediate, BoxOnItselfIsAnIsometryByTheCentreToo) {
  const TriangleMesh mesh = test::cube(4);
  IntermediateOptions options;
  options.rule = IntermediateRule::object_centroid;
  const ProjectionResult r = flatten_intermediate(mesh, options);
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

TEST(Environment, PanoramaIsTheSourcesFormula) {
  // A far eye in front of a sphere, y up: r = view - 2 (view·n) n with view = (0, 0, -1).
  TriangleMesh mesh = test::uv_sphere(10, 32, 64);
  for (Vec3& p : mesh.positions) p = {p.x, p.z, -p.y};
  EnvironmentOptions options;
  options.up = UpAxis::y;
  options.map = EnvironmentMap::equal_area;
  options.eye = Vec3{0, 0, 1e9};
  const CornerAttribute<Vec2> uv = environment_uv(mesh, options);
  ASSERT_EQ(uv.indices.size(), mesh.triangles.size());
  std::size_t checked = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 n = normalized(mesh.positions[mesh.triangles[t][k]]);
      const Vec3 r{2 * n.z * n.x, 2 * n.z * n.y, 2 * n.z * n.z - 1};
      if (std::hypot(r.x, r.z) < 0.05 || n.z < 0.05) continue;
      const Vec2 own = uv.values[uv.indices[t][k]];
      const double u = 0.5 * (1 + std::atan2(r.x, r.z) / std::numbers::pi);
      EXPECT_NEAR(std::remainder(own.x - u, 1), 0, 0.02);
      EXPECT_NEAR(own.y, 0.5 * (r.y + 1), 0.02);
      ++checked;
    }
  EXPECT_GT(checked, mesh.triangles.size() / 2);
  const auto at = [&](Vec3 normal) {  // the vertex with this normal
    std::size_t best = 0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      if (dot(mesh.positions[v], normal) > dot(mesh.positions[best], normal)) best = v;
    return uv.values[best];
  };
  // Facing the eye it shows what is behind the eye: the middle. Turned by 45° to the right and up: right, up.
  const double root = std::sqrt(0.5);
  EXPECT_NEAR(at({0, 0, 1}).x, 0.5, 1e-4);
  EXPECT_NEAR(at({0, 0, 1}).y, 0.5, 1e-4);
  EXPECT_NEAR(at({root, 0, root}).x, 0.75, 1e-4);
  EXPECT_NEAR(at({-root, 0, root}).x, 0.25, 1e-4);
  EXPECT_NEAR(at({0, root, root}).y, 1, 1e-4);
}

TEST(Environment, PanoramaRunsOnOverItsEnds) {
  const TriangleMesh mesh = test::uv_sphere(10, 32, 64);
  EnvironmentOptions options;
  options.map = EnvironmentMap::equal_area;
  const CornerAttribute<Vec2> uv = environment_uv(mesh, options);
  EXPECT_GT(uv.values.size(), mesh.positions.size());  // some triangles lie across the back
  double most = 0;
  for (const Triangle& t : uv.indices)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 p = uv.values[t[k]];
      EXPECT_GE(p.x, 0);
      EXPECT_LT(p.x, 2);
      most = std::max(most, std::abs(p.x - uv.values[t[(k + 1) % 3]].x));
    }
  EXPECT_LE(most, 2.0 / 3);  // three corners leave a gap of a third of the circle at least
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
