// SPDX-License-Identifier: MIT
#include "papilla/meshing/fill_holes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "meshing/shapes.hpp"
#include "papilla/core/error.hpp"
#include "papilla/meshing/repair.hpp"
#include "papilla/meshing/statistics.hpp"

namespace papilla {
namespace {

using namespace test;

TriangleMesh without_triangles(TriangleMesh mesh, std::size_t first, std::size_t count) {
  const auto begin = mesh.triangles.begin() + static_cast<std::ptrdiff_t>(first);
  mesh.triangles.erase(begin, begin + static_cast<std::ptrdiff_t>(count));
  return mesh;
}

/// A 10 x 10 grid that is torn open along y = 5 between x = 2 and x = 8: a lens of the given width.
TriangleMesh torn_grid(double width) {
  TriangleMesh mesh = grid(10, 10);
  for (int x = 3; x < 8; ++x) {
    const Vec3 at{double(x), 5, 0};
    const auto place = std::find(mesh.positions.begin(), mesh.positions.end(), at);
    const Index v = static_cast<Index>(place - mesh.positions.begin());
    mesh.positions.push_back({at.x, 5 + width, 0});
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      if (mesh.corner(t, 0).y + mesh.corner(t, 1).y + mesh.corner(t, 2).y > 15)
        for (Index& corner : mesh.triangles[t])
          if (corner == v) corner = static_cast<Index>(mesh.positions.size() - 1);
  }
  return mesh;
}

TEST(FillHoles, NothingUnlessAsked) {
  const FillHolesResult result = fill_holes(without_triangles(cube(1), 0, 2), {});
  EXPECT_EQ(result.triangles, 0u);
  EXPECT_EQ(result.mesh.triangles.size(), 10u);
}

TEST(FillHoles, ClosesCube) {
  const FillHolesResult result = fill_holes(without_triangles(cube(1), 0, 2), {.max_diameter_mm = 1.5});
  EXPECT_EQ(result.holes, 1u);
  EXPECT_EQ(result.triangles, 2u);
  const MeshStatistics s = mesh_statistics(result.mesh);
  EXPECT_EQ(s.boundary_edges, 0u);
  ASSERT_TRUE(s.volume_mm3);
  EXPECT_NEAR(*s.volume_mm3, 1, 1e-15);
}

TEST(FillHoles, CapsOfTubeHaveAreaOfPolygon) {
  for (const int n : {3, 4, 12, 50}) {
    const FillHolesResult result = fill_holes(tube(n, 3), {.max_diameter_mm = 3});
    EXPECT_EQ(result.holes, 2u);
    const double polygon = 0.5 * n * std::sin(2 * std::numbers::pi / n);
    EXPECT_NEAR(area(result.mesh), area(tube(n, 3)) + 2 * polygon, 1e-12);
    EXPECT_NEAR(signed_volume(result.mesh), 2 * polygon, 1e-12);
  }
}

TEST(FillHoles, LargerHolesStayOpen) {
  EXPECT_EQ(fill_holes(tube(12, 3), {.max_diameter_mm = 2.7}).holes, 0u);  // the caps' boxes are 2 x 2: 2.83
  EXPECT_EQ(fill_holes(tube(12, 3), {.max_diameter_mm = 3, .max_edges = 11}).holes, 0u);
}

TEST(FillHoles, SlitUpToItsWidth) {
  const TriangleMesh torn = torn_grid(0.01);
  ASSERT_EQ(mesh_statistics(torn).boundary_loops, 2u);
  EXPECT_EQ(fill_holes(torn, {.max_slit_width_mm = 0.005}).slits, 0u);
  const FillHolesResult result = fill_holes(torn, {.max_slit_width_mm = 0.0101});
  EXPECT_EQ(result.slits, 1u);
  EXPECT_EQ(result.holes, 0u);
  EXPECT_LE(result.max_slit_width_mm, 0.01);
  EXPECT_GT(result.max_slit_width_mm, 0.009);
  EXPECT_EQ(mesh_statistics(result.mesh).boundary_loops, 1u);
  EXPECT_NEAR(area(result.mesh), 100, 1e-12);
}

TEST(FillHoles, OuterBordersOfSheetsAreNoHoles) {
  for (const TriangleMesh& sheet : {grid(1, 1), grid(3, 2), terrain(4, 0.1, 3)}) {
    const FillHolesResult result = fill_holes(sheet, {.max_slit_width_mm = 10, .max_diameter_mm = 10});
    EXPECT_EQ(result.triangles, 0u);
    EXPECT_EQ(result.refused, 1u);
  }
}

TEST(FillHoles, CornersTakeWhatTheSurfaceHas) {
  TriangleMesh mesh = torn_grid(0.01);
  set_uv_to_xy(mesh);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    mesh.material.push_back(mesh.corner(t, 0).x + mesh.corner(t, 1).x + mesh.corner(t, 2).x < 15 ? 3 : 4);
  const FillHolesResult result = fill_holes(mesh, {.max_slit_width_mm = 0.1});
  ASSERT_GT(result.triangles, 0u);
  EXPECT_TRUE(uv_is_xy(result.mesh, 1e-12));
  ASSERT_EQ(result.mesh.material.size(), result.mesh.triangles.size());
  for (std::size_t t = mesh.triangles.size(); t < result.mesh.triangles.size(); ++t)
    EXPECT_TRUE(result.mesh.material[t] == 3 || result.mesh.material[t] == 4);
}

TEST(FillHoles, MissingValuesStayMissing) {
  TriangleMesh mesh = torn_grid(0.01);
  set_uv_to_xy(mesh);
  for (Triangle& t : mesh.uv.indices) t.fill(k_no_value);
  const FillHolesResult result = fill_holes(mesh, {.max_slit_width_mm = 0.1});
  ASSERT_GT(result.triangles, 0u);
  for (std::size_t t = 0; t < result.mesh.triangles.size(); ++t) EXPECT_FALSE(result.mesh.uv.has_value(t));
}

TEST(FillHoles, RefusesBadOptions) {
  EXPECT_THROW(fill_holes(cube(1), {.max_slit_width_mm = -1}), InvalidInput);
  EXPECT_THROW(fill_holes(cube(1), {.max_diameter_mm = std::numeric_limits<double>::quiet_NaN()}), InvalidInput);
}

TEST(RepairGaps, SlitsCloseAndHolesOnRequest) {
  const TriangleMesh torn = joined(torn_grid(1e-3), moved(tube(8, 2), {20, 0, 0}));  // diagonal 24.6
  const RepairResult usual = repair(torn);
  EXPECT_EQ(usual.counts.stitched_gaps, 1u);
  EXPECT_EQ(usual.counts.filled_holes, 0u);
  EXPECT_EQ(mesh_statistics(usual.mesh).boundary_loops, 3u);
  EXPECT_LE(usual.deviations.stitches, usual.stitch_tolerance_mm);
  EXPECT_LE(usual.max_deviation_mm, 1e-3);

  EXPECT_EQ(repair(torn, {.stitch_mm = 0}).counts.stitched_gaps, 0u);

  const RepairResult filled = repair(torn, {.fill_holes_mm = 3});
  EXPECT_EQ(filled.counts.filled_holes, 2u);
  EXPECT_EQ(mesh_statistics(filled.mesh).boundary_loops, 1u);
  const RepairResult again = repair(filled.mesh, {.fill_holes_mm = 3});
  EXPECT_EQ(again.mesh.triangles, filled.mesh.triangles);
}

TEST(RepairGaps, RefusesBadOptions) {
  EXPECT_THROW(repair(cube(1), {.stitch_mm = -1}), InvalidInput);
  EXPECT_THROW(repair(cube(1), {.fill_holes_mm = std::numeric_limits<double>::infinity()}), InvalidInput);
}

}  // namespace
}  // namespace papilla
