// SPDX-License-Identifier: MIT
#include "papilla/meshing/uv_charts.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "evaluate/kinds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/temporary_folder.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/meshing/chart_cuts.hpp"
#include "papilla/meshing/chart_topology.hpp"
#include "papilla/param/components.hpp"
#include "papilla/param/measure.hpp"
#include "papilla/pipeline/unwrap_scene.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla {
namespace {

/// A cube whose uv are a strip of four sides in one piece, and the two lids: three charts, nine seams.
TriangleMesh boxed_cube() {
  TriangleMesh mesh = test::cube(10);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
    const Vec3 normal = cross(b - a, c - a);
    Triangle corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = mesh.corner(t, static_cast<int>(k));
      Vec2 uv;
      if (normal.z > 0) uv = {p.x, 100 + p.y};
      if (normal.z < 0) uv = {p.x, 200 - p.y};
      if (normal.y < 0) uv = {p.x, p.z};
      if (normal.x > 0) uv = {10 + p.y, p.z};
      if (normal.y > 0) uv = {30 - p.x, p.z};
      if (normal.x < 0) uv = {40 - p.y, p.z};
      corners[k] = static_cast<Index>(mesh.uv.values.size());
      mesh.uv.values.push_back(uv);
    }
    mesh.uv.indices.push_back(corners);
  }
  return mesh;
}

Scene scene_of(TriangleMesh mesh) {
  Scene scene;
  scene.parts.resize(1);
  scene.parts[0].name = "part";
  scene.parts[0].mesh = std::move(mesh);
  return scene;
}

UnwrapOptions uv_charts_by(UnwrapMethod method) {
  UnwrapOptions options;
  options.method.method = method;
  options.method.charts = ChartSource::uv;
  return options;
}

TEST(UvCharts, AreThoseOfTheSeams) {
  const TriangleMesh mesh = boxed_cube();
  const ChartSet charts = uv_charts(mesh);
  EXPECT_EQ(charts.count, 3u);
  EXPECT_NEAR(charts.seam_length_mm, 90, 1e-12);  // eight edges of the lids and the end of the strip
  EXPECT_EQ(charts.cuts.size(), 1u);              // the end of the strip
  EXPECT_NEAR(measure_distortion(mesh, mesh.uv).seam_length_mm, 90, 1e-12);
  std::size_t eight = 0;
  for (const ChartTopology& t : chart_topologies(mesh, charts)) {
    EXPECT_TRUE(t.is_disk());
    eight += t.triangles == 8;
  }
  EXPECT_EQ(eight, 1u);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t s = 0; s < t; ++s) {
      const auto group = [&](std::size_t i) {  // by the height of the uv, as made above
        return static_cast<int>(mesh.uv.values[mesh.uv.indices[i][0]].y / 60);
      };
      EXPECT_EQ(group(t) == group(s), charts.of_triangle[t] == charts.of_triangle[s]);
    }
}

TEST(UvCharts, AllMethodsMapTheSameCharts) {
  for (const auto& [name, method] : unwrap_methods()) {
    if (!takes_charts(method)) continue;
    const UnwrapResult result = unwrap_scene(scene_of(boxed_cube()), uv_charts_by(method));
    EXPECT_EQ(result.charts, 3u) << name;
    EXPECT_TRUE(result.parts[0].flattening.notes.empty() || method == UnwrapMethod::arap) << name;
    const TriangleMesh& mesh = result.scene.parts[0].mesh;
    const ChartSet charts = uv_charts(mesh);  // of the new uv
    EXPECT_EQ(charts.of_triangle, uv_charts(boxed_cube()).of_triangle) << name;
    EXPECT_EQ(charts.cuts, uv_charts(boxed_cube()).cuts) << name;
    const DistortionReport r = measure_distortion(mesh, mesh.uv);
    EXPECT_EQ(r.flipped + r.overlapping_triangles, 0u) << name;
    EXPECT_NEAR(r.seam_length_mm, 90, 1e-9) << name;
    if (method == UnwrapMethod::best) {
      EXPECT_NEAR(r.symmetric_dirichlet.max, 4, 1e-5);
    }
  }
}

TEST(UvCharts, HolesStay) {
  TriangleMesh tube = test::cylinder(30, 100, 24, 4);
  tube.uv = {{{0, 0}}, Values<Triangle>(tube.triangles.size(), Triangle{0, 0, 0})};  // no seam at all
  const UnwrapResult result = unwrap_scene(scene_of(tube), uv_charts_by(UnwrapMethod::best));
  EXPECT_EQ(result.charts, 1u);
  EXPECT_TRUE(result.parts[0].flattening.charts.cuts.empty());
}

TEST(UvCharts, ClosedOnesAreOpenedOnceForAllMethods) {
  for (TriangleMesh mesh : {test::uv_sphere(10, 8, 12), test::torus(30, 10, 16, 8)}) {
    mesh.uv = {{{0, 0}}, Values<Triangle>(mesh.triangles.size(), Triangle{0, 0, 0})};
    for (const ChartSource source : {ChartSource::keep, ChartSource::uv}) {
      const ChartSet opened = given_charts(mesh, source);
      EXPECT_EQ(opened.count, 1u);
      EXPECT_TRUE(chart_topologies(mesh, opened)[0].is_disk());
      for (const UnwrapMethod method : {UnwrapMethod::tutte, UnwrapMethod::best, UnwrapMethod::maillot}) {
        UnwrapOptions options = uv_charts_by(method);
        options.method.charts = source;
        const UnwrapResult result = unwrap_scene(scene_of(mesh), options);
        EXPECT_EQ(result.charts, 1u);
        EXPECT_EQ(result.parts[0].flattening.charts.cuts, opened.cuts);
        EXPECT_EQ(uv_charts(result.scene.parts[0].mesh).cuts, opened.cuts);
      }
    }
  }
}

TEST(UvCharts, OpenChartsComeBackAsTheyAre) {
  const TriangleMesh mesh = boxed_cube();
  const ChartSet charts = uv_charts(mesh), same = open_closed_charts(mesh, charts);
  EXPECT_EQ(same.of_triangle, charts.of_triangle);
  EXPECT_EQ(same.cuts, charts.cuts);
}

TEST(UvCharts, WithoutUvAreRefusedByName) {
  Scene scene = scene_of(boxed_cube());
  scene.parts.push_back(scene.parts[0]);
  scene.parts[1].name = "lid";
  scene.parts[1].mesh.uv.indices[4] = {k_no_value, k_no_value, k_no_value};
  try {
    unwrap_scene(scene, uv_charts_by(UnwrapMethod::best));
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("part 'lid': 1 of 12 triangles"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("triangle[4]"), std::string::npos) << error.what();
  }
  TriangleMesh mesh = boxed_cube();
  mesh.uv.values[0].x = NAN;
  EXPECT_THROW(uv_charts(mesh), InvalidInput);
  mesh = boxed_cube();
  mesh.uv.indices[0][0] = 1000;
  EXPECT_THROW(uv_charts(mesh), InvalidInput);
}

TEST(EvaluateParam, AllMethodsGetTheChartsOfTheFile) {
  const TemporaryFolder folder("papilla-test");
  const std::string file = (folder.path() / "cube.obj").string();
  Part part;
  part.name = "cube";
  part.mesh = boxed_cube();
  write_scene(single_part_scene(std::move(part), "OBJ"), file);
  ParamComparison comparison;
  comparison.charts = ChartSource::uv;
  comparison.methods = {UnwrapMethod::best, UnwrapMethod::tutte, UnwrapMethod::lscm, UnwrapMethod::planar};
  const auto rows = [&] {
    std::vector<EvaluatedMap> maps;
    for (const EvaluationRun& run : evaluate_param({file, "cube.obj", {}, {}, Budget(5), comparison}))
      if (run.map) maps.push_back(*run.map);
    return maps;
  };
  const std::vector<EvaluatedMap> maps = rows(), again = rows();
  ASSERT_EQ(maps.size(), 5u);  // lscm has two solvers
  ASSERT_EQ(again.size(), 5u);
  for (std::size_t i = 0; i < maps.size(); ++i) {
    EXPECT_EQ(maps[i].failure, "");
    EXPECT_EQ(maps[i].given_charts, 3u);
    EXPECT_EQ(maps[i].charts, 3u);
    EXPECT_EQ(maps[i].replaced, 0u);
    EXPECT_EQ(maps[i].triangles, 12u);
    EXPECT_EQ(maps[i].distortion.symmetric_dirichlet.mean, again[i].distortion.symmetric_dirichlet.mean);
  }
  EXPECT_NEAR(maps[3].distortion.symmetric_dirichlet.mean, 4, 1e-5);  // best
  comparison.charts = ChartSource::keep;
  comparison.methods = {UnwrapMethod::tutte};
  const EvaluatedMap closed = rows().front();
  EXPECT_EQ(closed.given_charts, 1u);  // opened
  EXPECT_TRUE(closed.valid);
}

}  // namespace
}  // namespace papilla
