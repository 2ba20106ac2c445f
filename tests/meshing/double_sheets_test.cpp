// SPDX-License-Identifier: MIT
// Sheets that a file holds twice, in both senses: what repair() leaves of them.
#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "meshing/clean_mesh.hpp"
#include "meshing/shapes.hpp"
#include "papilla/meshing/deviation.hpp"
#include "papilla/meshing/repair.hpp"
#include "papilla/meshing/statistics.hpp"

namespace papilla {
namespace {

using namespace test;

/// Clean, as far from the input as it says, and as it is when it is repaired again.
void expect_honest(const TriangleMesh& mesh, const RepairResult& result) {
  EXPECT_TRUE(result.settled);
  EXPECT_EQ(result.refused_triangles, 0u);
  test::expect_clean(result.mesh);
  const DeviationResult measured = surface_deviation(mesh, result.mesh);
  EXPECT_GE(1.01 * result.lost_mm + 1e-6 * result.tolerance_mm, measured.from_to.value);
  EXPECT_GE(1.01 * result.added_mm + 1e-6 * result.tolerance_mm, measured.to_from.value);
  EXPECT_LE(measured.bound(), result.tolerance_mm);
  const RepairResult again = repair(result.mesh);
  EXPECT_EQ(again.mesh.positions, result.mesh.positions);
  EXPECT_EQ(again.mesh.triangles, result.mesh.triangles);
}

TriangleMesh doubled(const TriangleMesh& mesh) { return joined(mesh, reversed(mesh)); }

/// The four walls of a cabinet n wide, from -n to n, open above and below, fronts outwards.
TriangleMesh cabinet(int n) {
  TriangleMesh walls;
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto first = static_cast<Index>(walls.positions.size());
    walls.positions.insert(walls.positions.end(), {a, b, c});
    walls.triangles.push_back({first, first + 1, first + 2});
  };
  const double s = n;
  const Vec3 corners[] = {{0, 0, 0}, {s, 0, 0}, {s, s, 0}, {0, s, 0}};
  for (int side = 0; side < 4; ++side) {
    const Vec3 start = corners[side], step = (1 / s) * (corners[(side + 1) % 4] - start);
    for (int i = 0; i < n; ++i)
      for (int z = -n; z < n; ++z) {
        const Vec3 a = start + double(i) * step + Vec3{0, 0, double(z)}, b = a + step, up{0, 0, 1};
        add(a, b, b + up);
        add(a, b + up, a + up);
      }
  }
  return walls;
}

class Cabinet : public testing::TestWithParam<int> {};

/// The shelf's border carries two walls all around, but it can be seen from above and from below.
TEST_P(Cabinet, KeepsItsShelf) {
  const int n = GetParam();
  for (const TriangleMesh& walls : {cabinet(n), reversed(cabinet(n)), doubled(cabinet(n))}) {
    const TriangleMesh mesh = joined(walls, doubled(grid(n, n)));
    const RepairResult result = repair(mesh);
    expect_honest(mesh, result);
    double seen = 0;  // of the shelf, from above and below
    for (std::size_t t = 0; t < result.mesh.triangles.size(); ++t) {
      const Vec3 a = result.mesh.corner(t, 0);
      const Vec3 normal = cross(result.mesh.corner(t, 1) - a, result.mesh.corner(t, 2) - a);
      seen += 0.5 * std::abs(normal.z);
    }
    const bool one_side = result.two_sided == std::set<std::uint32_t>{0};
    EXPECT_NEAR(seen, (one_side ? 1 : 2) * n * n, 1e-2);
  }
}
INSTANTIATE_TEST_SUITE_P(Sizes, Cabinet, testing::Values(1, 2, 5));

/// One cube deep, n wide and high.
TriangleMesh block(int x, int n) {
  std::set<Voxel> filled;
  for (int y = 0; y < n; ++y)
    for (int z = 0; z < n; ++z) filled.insert({x, y, z});
  return voxels(filled);
}

TEST(DoubleSheets, TouchingSolidsStayTwo) {
  for (const int n : {1, 2, 4}) {
    const TriangleMesh touching = joined(block(0, n), block(1, n));
    const RepairResult result = repair(touching);
    expect_honest(touching, result);
    const MeshStatistics s = mesh_statistics(result.mesh);
    EXPECT_EQ(s.components, 2u);
    EXPECT_EQ(s.boundary_edges, 0u);
    EXPECT_NEAR(*s.volume_mm3, 2 * n * n, 1e-3 * n * n);
    EXPECT_EQ(result.counts.kept_walls, static_cast<std::size_t>(2 * n * n));
  }
}

/// Front and back of other materials: both are seen, so both stay.
TEST(DoubleSheets, OfTwoLooksKeepBothSides) {
  TriangleMesh triangle;
  triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.triangles = {{0, 1, 2}};
  for (const TriangleMesh& sheet : {triangle, grid(1, 1), grid(5, 5), terrain(8, 1, 3), tube(12, 4), sphere(5)}) {
    TriangleMesh mesh = doubled(sheet);
    mesh.material.assign(sheet.triangles.size(), 0);
    mesh.material.resize(mesh.triangles.size(), 1);
    const RepairResult result = repair(mesh);
    expect_honest(mesh, result);
    EXPECT_EQ(result.counts.kept_backs, sheet.triangles.size());
    EXPECT_EQ(result.mesh.triangles.size(), mesh.triangles.size());
    EXPECT_EQ(std::accumulate(result.mesh.material.begin(), result.mesh.material.end(), std::size_t{0}),
              sheet.triangles.size());
    EXPECT_TRUE(result.two_sided.empty());
  }
}

TEST(DoubleSheets, OfTwoTextureCoordinatesKeepBothSides) {
  TriangleMesh mesh = doubled(grid(3, 3));
  set_uv_to_xy(mesh);
  EXPECT_EQ(repair(mesh).counts.opposites, 18u);
  for (std::size_t t = 18; t < 36; ++t) mesh.uv.indices[t] = {0, 0, 0};
  EXPECT_EQ(repair(mesh).counts.kept_backs, 18u);
  TriangleMesh second = doubled(grid(3, 3));
  set_uv_to_xy(second);
  second.uv1 = second.uv;
  EXPECT_EQ(repair(second).counts.opposites, 18u);
  for (std::size_t t = 18; t < 36; ++t) second.uv1.indices[t] = {0, 0, 0};
  EXPECT_EQ(repair(second).counts.kept_backs, 18u);
}

TEST(Repair, LeavesPiecesThatWouldMoveTooFar) {
  TriangleMesh cracked = joined(grid(4, 4), moved(grid(4, 4), {4.001, 0, 0}));
  cracked = joined(cracked, moved(reversed(sphere(4)), {40, 0, 0}));
  RepairOptions options{.weld_mm = 0.01, .tolerance_mm = 1e-4};
  const RepairResult result = repair(cracked, options);
  EXPECT_EQ(result.refused_triangles, 64u);
  EXPECT_NEAR(result.refused_mm, 0.0005, 1e-5);  // The middle of the gap.
  EXPECT_EQ(result.lost_mm, 0);
  EXPECT_EQ(result.counts.welded_near, 0u);
  EXPECT_EQ(result.counts.reversed, sphere(4).triangles.size());
  options.tolerance_mm = 0.01;
  EXPECT_EQ(repair(cracked, options).refused_triangles, 0u);
  EXPECT_NEAR(repair(cracked, options).added_mm, 0.0005, 1e-5);
}

/// Samples find what the whole measure finds.
TEST(Repair, MeasuresLargePiecesBySamples) {
  TriangleMesh soup = soup_of(terrain(90, 2, 5));
  for (std::size_t i = 0; i < soup.positions.size(); ++i) soup.positions[i].z += i % 7 == 0 ? 0.004 : 0;
  const RepairResult whole = repair(soup, {.weld_mm = 0.01}),
                     sampled = repair(soup, {.weld_mm = 0.01, .sample_above = 0});
  EXPECT_FALSE(whole.sampled);
  EXPECT_TRUE(sampled.sampled);
  EXPECT_GT(whole.lost_mm, 1e-3);
  EXPECT_LE(sampled.lost_mm, 1.01 * whole.lost_mm);
  EXPECT_GE(sampled.lost_mm, 0.5 * whole.lost_mm);
  EXPECT_GE(sampled.added_mm, 0.5 * whole.added_mm);
}

}  // namespace
}  // namespace papilla
