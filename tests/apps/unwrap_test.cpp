// SPDX-License-Identifier: GPL-3.0-or-later
#include "unwrap/unwrap.hpp"

#include <gtest/gtest.h>

#include "distortion_report.hpp"
#include "papilla/core/error.hpp"
#include "papilla/param/measure.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla::app {
namespace {

Scene scene_of(TriangleMesh mesh) {
  Scene scene;
  scene.up = UpAxis::z;
  scene.parts.resize(1);
  scene.parts[0].name = "part";
  scene.parts[0].mesh = std::move(mesh);
  return scene;
}

UnwrapOptions options_of(UnwrapMethod method) {
  UnwrapOptions options;
  options.method.method = method;
  return options;
}

TEST(Unwrap, EveryMethodByNameGivesFiniteUvWithoutMirrors) {
  TriangleMesh mesh = test::cylinder(30, 80, 24, 6);
  mesh.cad_uv = mesh.uv;
  for (const auto& [name, method] : unwrap_methods()) {
    EXPECT_EQ(unwrap_method_name(method), name);
    Scene scene = scene_of(mesh);
    const UnwrapReport report = unwrap_scene(scene, options_of(method));
    ASSERT_FALSE(scene.parts[0].mesh.uv.empty()) << name;
    for (const Vec2 p : scene.parts[0].mesh.uv.values) EXPECT_TRUE(is_finite(p)) << name;
    if (method == UnwrapMethod::environment) continue;
    const DistortionReport r = measure_distortion(scene.parts[0].mesh, scene.parts[0].mesh.uv);
    EXPECT_EQ(r.mirrored_charts, 0u) << name;
    EXPECT_EQ(r.flipped, 0u) << name;
  }
}

TEST(Unwrap, AutomaticProjectsWhatIsSmallerThanTheGrain) {
  UnwrapOptions options = options_of(UnwrapMethod::automatic);
  options.tile_mm = {100, 100};
  Scene scene = scene_of(test::cube(5));
  const UnwrapReport small = unwrap_scene(scene, options);
  EXPECT_EQ(small.parts[0].method, "triplanar");
  EXPECT_NE(small.parts[0].reason.find("8.66 mm"), std::string::npos) << small.parts[0].reason;
  scene = scene_of(test::cube(500));
  const UnwrapReport large = unwrap_scene(scene, options);
  EXPECT_EQ(large.parts[0].method, "auto");
  EXPECT_EQ(large.parts[0].choices.size(), large.parts[0].flattening.charts.count);
  for (const ChartChoice& choice : large.parts[0].choices) EXPECT_EQ(choice.method, "exact");
}

TEST(Unwrap, GrainRunsAlongThePart) {
  TriangleMesh bar = test::cube(10);
  for (Vec3& p : bar.positions) p.x *= 8;
  UnwrapOptions options = options_of(UnwrapMethod::triplanar);
  options.method.grain = GrainSource::longest;
  options.layout = UvLayout::tile;
  Scene scene = scene_of(bar);
  unwrap_scene(scene, options);
  const TriangleMesh& mesh = scene.parts[0].mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 in_space = mesh.corner(t, static_cast<int>((k + 1) % 3)) - mesh.corner(t, static_cast<int>(k));
      const Vec2 edge = mesh.uv.values[mesh.uv.indices[t][(k + 1) % 3]] - mesh.uv.values[mesh.uv.indices[t][k]];
      if (in_space.y == 0 && in_space.z == 0) {
        EXPECT_NEAR(edge.y, in_space.x, 1e-9);
      }
    }
}

TEST(Unwrap, ASecondSetOfUvOverlapsNowhere) {
  UnwrapOptions options = options_of(UnwrapMethod::automatic);
  options.layout = UvLayout::tile;
  options.tile_mm = {20, 20};
  options.unique = UniqueUv{512, 3};
  options.density = {{"p*t", 2.0}};
  Scene scene = scene_of(test::torus(100, 30, 40, 20));
  scene.parts.push_back(scene.parts[0]);
  scene.parts[1].name = "other";
  const UnwrapReport report = unwrap_scene(scene, options);
  ASSERT_TRUE(report.unique);
  EXPECT_GE(report.unique->gutter_px, 3);
  TriangleMesh both;
  CornerAttribute<Vec2> uv;
  std::vector<double> area;
  for (const Part& part : scene.parts) {
    const auto first = static_cast<Index>(both.positions.size()), first_uv = static_cast<Index>(uv.values.size());
    for (const Vec3& p : part.mesh.positions) both.positions.push_back(p + Vec3{0, 0, 1000.0 * first});
    for (const Triangle& t : part.mesh.triangles) both.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    uv.values.insert(uv.values.end(), part.mesh.uv1.values.begin(), part.mesh.uv1.values.end());
    for (const Triangle& t : part.mesh.uv1.indices)
      uv.indices.push_back({first_uv + t[0], first_uv + t[1], first_uv + t[2]});
    area.push_back(measure_distortion(part.mesh, part.mesh.uv1).uv_area);
  }
  const DistortionReport r = measure_distortion(both, uv);
  EXPECT_EQ(r.overlapping_triangles, 0u);
  EXPECT_EQ(r.mirrored_charts, 0u);
  EXPECT_NEAR(area[0], 4 * area[1], 1e-9);  // twice the density
}

TEST(Unwrap, PinsHoldTheNearestVertex) {
  UnwrapOptions options = options_of(UnwrapMethod::levy);
  options.layout = UvLayout::tile;
  options.method.charts = ChartSource::keep;
  options.method.pins = {{{0, 0, 0.1}, {5, 7}}, {{40, 30, 0}, {45, 37}}};
  Scene scene = scene_of(test::plane(40, 30, 8, 6));
  unwrap_scene(scene, options);
  const TriangleMesh& mesh = scene.parts[0].mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = mesh.corner(t, static_cast<int>(k));
      EXPECT_NEAR(mesh.uv.values[mesh.uv.indices[t][k]].x, p.x + 5, 1e-6);
      EXPECT_NEAR(mesh.uv.values[mesh.uv.indices[t][k]].y, p.y + 7, 1e-6);
    }
}

TEST(Unwrap, KeepRefusesWhatIsNoSurface) {
  TriangleMesh mesh = test::plane(1, 1, 1, 1);
  mesh.uv = {};
  mesh.positions.push_back({0.5, 0.5, 1});
  mesh.triangles.push_back({mesh.triangles[0][0], mesh.triangles[0][1], 4});
  UnwrapOptions options = options_of(UnwrapMethod::best);
  options.method.charts = ChartSource::keep;
  Scene scene = scene_of(mesh);
  try {
    unwrap_scene(scene, options);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("edge ("), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("triangle["), std::string::npos) << error.what();
  }
}

TEST(DistortionReport, HistogramAddsUpAndColoursAreCorners) {
  Scene scene = scene_of(test::plane(4, 3, 4, 3));
  const SceneDistortion distortion = measure_scene(scene);
  const Json histograms = histogram_json(distortion.report);
  for (const auto& [name, histogram] : histograms.items()) {
    double sum = 0;
    for (const auto& share : histogram.at("area_fraction")) sum += share.get<double>();
    EXPECT_NEAR(sum, 1, 1e-12) << name;
    EXPECT_NEAR(histogram.at("area_fraction").front().get<double>(), 1, 1e-12) << name;  // an isometry
    EXPECT_EQ(histogram.at("area_fraction").size(), histogram.at("below").size() + 1);
  }
  colour_by_distortion(distortion, 5, scene);
  ASSERT_EQ(scene.parts[0].mesh.colors.indices.size(), scene.parts[0].mesh.triangles.size());
  EXPECT_LT(scene.parts[0].mesh.colors.values[0].g, scene.parts[0].mesh.colors.values[0].b);  // dark blue
}

}  // namespace
}  // namespace papilla::app
