// SPDX-License-Identifier: MIT
#include "papilla/meshing/repair.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "meshing/clean_mesh.hpp"
#include "meshing/shapes.hpp"
#include "papilla/core/error.hpp"
#include "papilla/meshing/statistics.hpp"

namespace papilla {
namespace {

using namespace test;

void expect_idempotent(const RepairResult& once) {
  const RepairResult twice = repair(once.mesh);
  EXPECT_EQ(twice.mesh.positions, once.mesh.positions);
  EXPECT_EQ(twice.mesh.triangles, once.mesh.triangles);
  EXPECT_EQ(twice.passes, 1u);
}

TEST(Repair, CleanMeshesStayAsTheyAre) {
  for (const TriangleMesh& mesh : {cube(3), sphere(6), torus(20, 12), tube(12, 4), double_torus(), terrain(9, 1, 4)}) {
    const RepairResult result = repair(mesh);
    EXPECT_TRUE(result.settled);
    EXPECT_EQ(result.mesh.positions, mesh.positions);
    EXPECT_EQ(result.mesh.triangles, mesh.triangles);
    EXPECT_EQ(result.counts, RepairCounts{});
    EXPECT_EQ(result.max_deviation_mm, 0);
  }
}

TEST(Repair, SoupOfSolidComesOutClosed) {
  const RepairResult result = repair(soup_of(reversed(double_torus())));
  const MeshStatistics s = mesh_statistics(result.mesh);
  EXPECT_EQ(s.boundary_edges, 0u);
  EXPECT_EQ(s.genus, 2);
  EXPECT_NEAR(*s.volume_mm3, 13, 1e-12);
  expect_idempotent(result);
}

class RandomSoup : public testing::TestWithParam<unsigned> {};

TEST_P(RandomSoup, ComesOutCleanAndStaysSo) {
  for (const int triangles : {5, 20, 60, 150}) {
    const RepairResult result = repair(lattice_soup(triangles, GetParam()));
    EXPECT_TRUE(result.settled) << triangles;
    test::expect_clean(result.mesh);
    expect_idempotent(result);
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomSoup, testing::Range(1u, 41u));

/// Noise far below the size of triangles, every triangle on its own: only cracks.
class Cracks : public testing::TestWithParam<unsigned> {};

TEST_P(Cracks, CloseAndNeverAddBorderLoops) {
  std::mt19937 random(GetParam());
  std::uniform_real_distribution<double> noise(-2e-7, 2e-7);
  for (const TriangleMesh& clean : {torus(30, 20), tube(20, 9), terrain(20, 0.3, GetParam()), sphere(7)}) {
    TriangleMesh soup = soup_of(clean);
    for (Vec3& p : soup.positions) p = p + Vec3{noise(random), noise(random), noise(random)};
    const RepairResult result = repair(soup);
    const MeshStatistics before = mesh_statistics(clean), after = mesh_statistics(result.mesh);
    EXPECT_EQ(after.boundary_loops, before.boundary_loops);
    EXPECT_EQ(after.vertices, before.vertices);
    EXPECT_EQ(after.genus, before.genus);
    EXPECT_LE(result.max_deviation_mm, result.weld_tolerance_mm);
    test::expect_clean(result.mesh);
    expect_idempotent(result);
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, Cracks, testing::Range(1u, 6u));

TEST(Repair, CountsWhatBecomesNothingByWelding) {
  TriangleMesh mesh;  // A tetrahedron with a crack along one edge, closed by a needle along another.
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1 + 1.5e-7, 0, 0}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {4, 2, 3}, {0, 3, 2}, {1, 2, 4}};
  const RepairResult result = repair(mesh);
  EXPECT_EQ(result.counts.welded_near, 1u);
  EXPECT_EQ(result.counts.repeated_corners, 1u);
  EXPECT_EQ(result.mesh.triangles.size(), 4u);
  test::expect_clean(result.mesh);
}

/// 1000.00005 mm and 1000 mm are two numbers of single precision, 1.00000005 m and 1 m are one.
TEST(Repair, VerticesThatAFileInMetresHoldsAsOneAreOne) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1000, 0, 0}, {0, 1000, 0}, {1000.00005, 0, 0}, {1000, 1000, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 2}};
  EXPECT_EQ(repair(mesh, {.weld_mm = 0}).mesh.positions.size(), 4u);
}

TEST(Repair, MoebiusStripBecomesOrientable) {
  const RepairResult result = repair(moebius(30));
  test::expect_clean(result.mesh);
  EXPECT_EQ(mesh_statistics(result.mesh).boundary_loops, 1u);
  expect_idempotent(result);
}

TEST(Repair, AttributesFollowTheirCorners) {
  TriangleMesh mesh = soup_of(terrain(12, 0.5, 9));
  set_uv_to_xy(mesh);
  mesh.triangles.push_back(mesh.triangles[3]);  // a duplicate, a repeated corner
  mesh.triangles.push_back({0, 0, 1});
  mesh.uv.indices = mesh.triangles;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) mesh.face.push_back(static_cast<std::uint32_t>(t));
  const RepairResult result = repair(mesh);
  EXPECT_EQ(result.counts.duplicates, 1u);
  EXPECT_EQ(result.counts.repeated_corners, 1u);
  ASSERT_EQ(result.mesh.triangles.size(), 288u);
  ASSERT_EQ(result.mesh.face.size(), 288u);
  EXPECT_TRUE(uv_is_xy(result.mesh, 1e-6));
  for (std::size_t t = 0; t < 288; ++t) EXPECT_EQ(result.mesh.face[t], t);
}

TEST(Repair, TrianglesMayLackAttributes) {
  TriangleMesh mesh = lattice_soup(120, 3);  // every operation has work
  set_uv_to_xy(mesh);
  mesh.normals.values = {{0, 0, 1}};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const bool given = t % 3 != 0;
    if (!given) mesh.uv.indices[t].fill(k_no_value);
    mesh.normals.indices.push_back(given ? Triangle{0, 0, 0} : Triangle{k_no_value, k_no_value, k_no_value});
  }
  const RepairResult result = repair(mesh);
  ASSERT_EQ(result.mesh.uv.indices.size(), result.mesh.triangles.size());
  std::size_t with = 0;
  for (std::size_t t = 0; t < result.mesh.triangles.size(); ++t) {
    EXPECT_EQ(result.mesh.uv.has_value(t), result.mesh.normals.has_value(t));
    with += result.mesh.uv.has_value(t);
  }
  EXPECT_GT(with, 0u);
  EXPECT_LT(with, result.mesh.triangles.size());
}

TEST(Repair, ScaleDoesNotMatter) {
  const TriangleMesh soup = lattice_soup(100, 5);
  const RepairResult reference = repair(soup);
  for (const double scale : {std::ldexp(1.0, -20), std::ldexp(1.0, 20)}) {
    TriangleMesh scaled = soup;
    for (Vec3& p : scaled.positions) p = scale * p;
    const RepairResult result = repair(scaled);
    EXPECT_EQ(result.mesh.triangles, reference.mesh.triangles);
    EXPECT_EQ(result.counts, reference.counts);
  }
}

TEST(Repair, NothingLeftIsNoError) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 0, 0}};
  const RepairResult result = repair(mesh);
  EXPECT_TRUE(result.settled);
  EXPECT_TRUE(result.mesh.triangles.empty());
  EXPECT_TRUE(repair({}).mesh.triangles.empty());
}

TEST(Repair, RefusesBadOptions) {
  RepairOptions options;
  options.max_passes = 0;
  EXPECT_THROW(repair(cube(), options), InvalidInput);
  options = {};
  options.weld_mm = std::nan("");
  EXPECT_THROW(repair(cube(), options), InvalidInput);
}

TriangleMesh scaled(TriangleMesh mesh, double factor) {
  for (Vec3& p : mesh.positions) p = factor * p;
  return mesh;
}

/// Solids are repaired one by one; a shell inside out lies in one of them, or does not.
TEST(Repair, CavitiesStayAndSolidsInsideOutAreTurned) {
  const TriangleMesh cavity = moved(reversed(cube(2)), {1, 1, 1});
  const TriangleMesh apart = moved(reversed(cube(2)), {10, 0, 0});
  for (const auto& mesh :
       {joined(scaled(cube(3), 4), joined(cavity, apart)), joined(joined(apart, cavity), scaled(cube(3), 4))}) {
    const RepairResult result = repair(soup_of(mesh));
    EXPECT_EQ(result.counts.reversed, apart.triangles.size());
    EXPECT_NEAR(*mesh_statistics(result.mesh).volume_mm3, 64 - 1 + 1, 1e-12);
    test::expect_clean(result.mesh);
    expect_idempotent(result);
  }
}

/// Solids apart from each other and open sheets, triangles dealt like cards: the numbers of their faces still ascend.
TEST(Repair, KeepsTheOrderOfTrianglesWhateverTheyBelongTo) {
  TriangleMesh mesh = joined(joined(sphere(5), moved(grid(6, 6), {0, 0, 9})), moved(torus(14, 9), {20, 0, 0}));
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), std::mt19937(7));
  TriangleMesh soup = soup_of(mesh);
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) soup.face.push_back(static_cast<std::uint32_t>(3 * t + 5));
  const RepairResult result = repair(soup);
  EXPECT_EQ(result.mesh.face, soup.face);
  for (std::size_t t = 0; t < soup.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) EXPECT_EQ(result.mesh.corner(t, k), mesh.corner(t, k));
  EXPECT_EQ(result.mesh.positions.size(), mesh.positions.size());
  expect_idempotent(result);
}

class Neighbours : public testing::TestWithParam<unsigned> {};

/// What is far away changes nothing as long as the diagonal, which tolerances go by, stays: a soup that needs every
/// operation comes out beside a solid as it does without it.
TEST_P(Neighbours, FarAwayChangeNothing) {
  TriangleMesh soup = lattice_soup(80, GetParam());
  soup = joined(soup, moved(grid(1, 1), {60, 0, 0}));
  const TriangleMesh solid = soup_of(moved(sphere(4), {40, 1, 1}));
  const RepairResult alone = repair(soup), beside = repair(joined(solid, soup));
  ASSERT_EQ(beside.weld_tolerance_mm, alone.weld_tolerance_mm);
  ASSERT_EQ(beside.mesh.triangles.size(), solid.triangles.size() + alone.mesh.triangles.size());
  RepairCounts with_solid = alone.counts;
  with_solid.welded_equal = beside.counts.welded_equal;
  EXPECT_EQ(beside.counts, with_solid);
  EXPECT_EQ(beside.max_deviation_mm, alone.max_deviation_mm);
  for (std::size_t t = 0; t < alone.mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) EXPECT_EQ(beside.mesh.corner(solid.triangles.size() + t, k), alone.mesh.corner(t, k));
  expect_idempotent(beside);
}
INSTANTIATE_TEST_SUITE_P(Seeds, Neighbours, testing::Range(1u, 13u));

TEST(Repair, WhatIsNotDoneByTheDeadlineStaysAsItCame) {
  const TriangleMesh mesh = joined(lattice_soup(60, 2), moved(soup_of(cube(2)), {100, 0, 0}));
  RepairOptions options;
  options.deadline = Deadline(-1);
  const RepairResult result = repair(mesh, options);
  EXPECT_FALSE(result.settled);
  EXPECT_EQ(result.unfinished_triangles, mesh.triangles.size());
  EXPECT_EQ(total_repair(std::vector{result, result}).unfinished_triangles, 2 * mesh.triangles.size());
  ASSERT_EQ(result.mesh.triangles.size(), mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) EXPECT_EQ(result.mesh.corner(t, k), mesh.corner(t, k));
  options.deadline = Deadline(60);
  EXPECT_EQ(repair(mesh, options).mesh.triangles, repair(mesh).mesh.triangles);
  EXPECT_EQ(repair(mesh, options).unfinished_triangles, 0U);
}

}  // namespace
}  // namespace papilla
