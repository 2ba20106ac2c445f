// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <random>

#include "meshing/shapes.hpp"
#include "papilla/core/error.hpp"
#include "papilla/meshing/degenerate.hpp"
#include "papilla/meshing/duplicate.hpp"
#include "papilla/meshing/manifold.hpp"
#include "papilla/meshing/orient.hpp"
#include "papilla/meshing/statistics.hpp"
#include "papilla/meshing/t_junction.hpp"
#include "papilla/meshing/weld.hpp"

namespace papilla {
namespace {

using namespace test;

TEST(Weld, EqualPositionsOfSoup) {
  const WeldResult result = weld_equal(soup_of(cube(4)));
  EXPECT_EQ(result.mesh.positions.size(), cube(4).positions.size());
  EXPECT_EQ(result.merged_equal, result.mesh.triangles.size() * 3 - result.mesh.positions.size());
  EXPECT_EQ(result.max_deviation_mm, 0);
}

TEST(Weld, ClosesCracksOfNoise) {
  TriangleMesh soup = soup_of(sphere(8));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> noise(-1e-7, 1e-7);
  for (Vec3& p : soup.positions) p = p + Vec3{noise(random), noise(random), noise(random)};
  const WeldResult result = weld(soup);
  EXPECT_EQ(result.mesh.positions.size(), sphere(8).positions.size());
  EXPECT_EQ(mesh_statistics(result.mesh).boundary_edges, 0u);
  EXPECT_GT(result.max_deviation_mm, 0);
  EXPECT_LE(result.max_deviation_mm, result.tolerance_mm);
}

TEST(Weld, KeepsRealFeaturesWhateverTheTolerance) {
  WeldOptions options;
  options.tolerance_mm = 100;
  const TriangleMesh mesh = grid(10, 10);
  const WeldResult result = weld(mesh, options);
  EXPECT_EQ(result.mesh.positions, mesh.positions);
  EXPECT_EQ(result.mesh.triangles, mesh.triangles);
}

TEST(Weld, UserToleranceClosesWiderGaps) {
  const TriangleMesh apart = joined(grid(4, 4), moved(grid(4, 4), {4.1, 0, 0}));
  EXPECT_EQ(weld(apart).merged_near, 0u);
  WeldOptions options;
  options.tolerance_mm = 0.2;
  const WeldResult result = weld(apart, options);
  EXPECT_EQ(result.merged_near, 5u);
  EXPECT_NEAR(result.max_deviation_mm, 0.1, 1e-12);
}

/// A sliver of 10 mm with an end of 0.01 mm; a border of 0.1 mm beside one of 10 mm.
TEST(Weld, TheShortestEdgeAtEitherVertexIsWhatItMayMove) {
  WeldOptions options;
  options.tolerance_mm = 2;
  TriangleMesh sliver;
  sliver.positions = {{0, 0, 0}, {0.01, 0, 0}, {0, 10, 0}};
  sliver.triangles = {{0, 1, 2}};
  EXPECT_EQ(weld(sliver, options).mesh.triangles, sliver.triangles);
  sliver.positions.push_back({-10, 0, 0});
  for (const Triangle& beside : {Triangle{0, 2, 3}, Triangle{2, 3, 0}, Triangle{3, 0, 2}}) {
    sliver.triangles = {{0, 1, 2}, beside};
    EXPECT_EQ(weld(sliver, options).mesh.triangles, sliver.triangles);
  }
  TriangleMesh fine, coarse;
  fine.positions = {{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}};
  coarse.positions = {{0.3, 0.3, 0}, {10, 0, 0}, {0, 10, 0}};
  fine.triangles = coarse.triangles = {{0, 1, 2}};
  EXPECT_EQ(weld(joined(fine, coarse), options).merged_near, 0u);
  EXPECT_EQ(weld(joined(coarse, fine), options).merged_near, 0u);
}

TEST(Weld, RefusesBadOptions) {
  WeldOptions options;
  options.feature_fraction = 0.5;
  EXPECT_THROW(weld(cube(), options), InvalidInput);
  options = {};
  options.tolerance_mm = -1;
  EXPECT_THROW(weld(cube(), options), InvalidInput);
}

TEST(Duplicates, KeepsTheFirstAndTellsTheSense) {
  TriangleMesh mesh = grid(2, 1);
  const auto first = mesh.triangles;
  mesh.triangles.push_back({first[0][1], first[0][2], first[0][0]});
  mesh.triangles.push_back({first[3][1], first[3][0], first[3][2]});
  const DuplicateResult result = remove_duplicates(mesh);
  EXPECT_EQ(result.same, 1u);
  EXPECT_EQ(result.opposite, 1u);
  EXPECT_EQ(result.mesh.triangles, first);
}

TEST(Duplicates, DoubleSheetKeepsOneSide) {
  const DuplicateResult result = remove_duplicates(weld_equal(joined(grid(5, 5), reversed(grid(5, 5)))).mesh);
  EXPECT_EQ(result.opposite, 50u);
  EXPECT_EQ(result.kept_walls + result.kept_backs, 0u);
  EXPECT_EQ(result.two_sided, std::set<std::uint32_t>{0});
  EXPECT_EQ(result.mesh.triangles.size(), 50u);
}

TEST(Duplicates, WallBetweenTouchingSolidsStays) {
  const TriangleMesh two = weld_equal(joined(voxels({{0, 0, 0}}), voxels({{1, 0, 0}}))).mesh;
  const DuplicateResult result = remove_duplicates(two);
  EXPECT_EQ(result.kept_walls, 2u);
  EXPECT_EQ(result.mesh.triangles, two.triangles);
}

TEST(Duplicates, SheetOfTwoColoursKeepsBothSides) {
  TriangleMesh sheet = weld_equal(joined(grid(5, 5), reversed(grid(5, 5)))).mesh;
  sheet.material.assign(50, 3);
  sheet.material.resize(100, 4);
  EXPECT_EQ(remove_duplicates(sheet).kept_backs, 50u);
  sheet.material.assign(100, 3);
  const DuplicateResult result = remove_duplicates(sheet);
  EXPECT_EQ(result.opposite, 50u);
  EXPECT_EQ(result.two_sided, std::set<std::uint32_t>{3});
}

/// A grid whose vertex between two neighbours was moved onto the line between them, so that a cap arises.
TriangleMesh grid_with_cap() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0.6, 0, 0}, {1, 1, 0}, {1, -1, 0}};
  mesh.triangles = {{0, 2, 3}, {2, 1, 3}, {0, 1, 2}, {0, 4, 1}};  // the cap 0-1-2 lies between both sides
  return mesh;
}

TEST(Degenerate, CapIsFlippedWithoutOpeningTheSurface) {
  TriangleMesh mesh = grid_with_cap();
  set_uv_to_xy(mesh);
  mesh.material = {0, 0, 1, 2};
  const DegenerateResult result = remove_degenerate(mesh);
  EXPECT_EQ(result.flipped, 1u);
  const MeshStatistics s = mesh_statistics(result.mesh);
  EXPECT_EQ(s.triangles, 4u);
  EXPECT_EQ(s.degenerate_triangles, 0u);
  EXPECT_EQ(s.boundary_edges, 4u);
  EXPECT_EQ(s.t_junctions, 0u);
  EXPECT_NEAR(area(result.mesh), 2, 1e-12);
  EXPECT_TRUE(uv_is_xy(result.mesh, 1e-12));
  EXPECT_EQ(std::count(result.mesh.material.begin(), result.mesh.material.end(), 2u), 2);
}

TEST(Degenerate, NeedleIsCollapsed) {
  TriangleMesh mesh = sphere(6);
  const Triangle t = mesh.triangles[40];
  mesh.positions[t[1]] = mesh.positions[t[0]] + Vec3{1e-9, 0, 0};
  const DegenerateResult result = remove_degenerate(mesh);
  EXPECT_GE(result.collapsed, 1u);
  EXPECT_NEAR(result.max_deviation_mm, 1e-9, 1e-12);
  const MeshStatistics s = mesh_statistics(result.mesh);
  EXPECT_EQ(s.degenerate_triangles, 0u);
  EXPECT_EQ(s.boundary_edges, 0u);
  EXPECT_EQ(s.nonmanifold_edges, 0u);
}

TEST(Degenerate, StripOfCapsEnds) {
  TriangleMesh mesh;  // a fan of collinear points between two apexes
  const int n = 200;
  for (int i = 0; i <= n; ++i) mesh.positions.push_back({double(i), 0, 0});
  mesh.positions.push_back({n / 2.0, 50, 0});
  mesh.positions.push_back({n / 2.0, -50, 0});
  const Index up = n + 1, down = n + 2;
  for (Index i = 0; i < n; ++i) mesh.triangles.push_back({i, i + 1, up});
  for (Index i = 1; i < n; ++i) mesh.triangles.push_back({0, i + 1, i});  // all flat
  mesh.triangles.push_back({0, down, n});
  const DegenerateResult result = remove_degenerate(mesh);
  EXPECT_EQ(result.found, n - 1u);
  const MeshStatistics s = mesh_statistics(result.mesh);
  EXPECT_EQ(s.degenerate_triangles, 0u);
  EXPECT_EQ(s.boundary_edges, 4u);
  EXPECT_EQ(s.boundary_loops, 1u);
  EXPECT_NEAR(area(result.mesh), 200 * 50, 1e-6);
}

TEST(Degenerate, QuadrangleFlatEitherWayMovesByTolerancesOnly) {
  // c lies on a-b and b on c-d: either diagonal of a-c-b-d leaves a cap.
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {100, 0, 0}, {99, 6e-6, 0}, {105, -3e-5, 0}, {50, 50, 0}, {50, -50, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {0, 5, 3}};
  const DegenerateResult result = remove_degenerate(mesh);
  EXPECT_GE(result.found, 1u);
  EXPECT_GE(result.pushed, 1u);
  EXPECT_EQ(result.left, 0u);
  EXPECT_LT(result.max_deviation_mm, 1e-4);
  const MeshStatistics s = mesh_statistics(result.mesh);
  EXPECT_EQ(s.degenerate_triangles, 0u);
  EXPECT_EQ(s.boundary_loops, 1u);
  EXPECT_EQ(s.nonmanifold_edges, 0u);
  EXPECT_NEAR(area(result.mesh), area(mesh), 1e-2);
}

TEST(TJunctions, SharedEdgeClosesAndAttributesFollow) {
  TriangleMesh mesh = joined(grid(4, 1), TriangleMesh{});
  mesh.positions.push_back({2, -3, 0});
  mesh.triangles.push_back({0, 10, 4});  // one triangle below four edges
  set_uv_to_xy(mesh);
  const TJunctionResult result = split_t_junctions(mesh);
  EXPECT_EQ(result.split_edges, 1u);
  EXPECT_EQ(result.inserted_vertices, 3u);
  EXPECT_EQ(result.mesh.triangles.size(), 12u);
  const MeshStatistics s = mesh_statistics(result.mesh);
  EXPECT_EQ(s.t_junctions, 0u);
  EXPECT_EQ(s.components, 1u);
  EXPECT_EQ(s.flipped_edges, 0u);
  EXPECT_NEAR(area(result.mesh), area(mesh), 1e-12);
  EXPECT_TRUE(uv_is_xy(result.mesh, 1e-12));
}

TEST(TJunctions, AllThreeSidesOfOneTriangle) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {6, 0, 0}, {0, 6, 0},  {2, 0, 0}, {3, 3, 0},
                    {0, 3, 0}, {4, 0, 0}, {3, -5, 0}, {9, 9, 0}, {-5, 3, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 7, 3}, {3, 7, 6}, {6, 7, 1}, {1, 8, 4}, {4, 8, 2}, {2, 9, 5}, {5, 9, 0}};
  const TJunctionResult result = split_t_junctions(mesh);
  EXPECT_EQ(result.inserted_vertices, 4u);
  const MeshStatistics s = mesh_statistics(result.mesh);
  EXPECT_EQ(s.t_junctions, 0u);
  EXPECT_EQ(s.components, 1u);
  EXPECT_EQ(s.boundary_loops, 1u);
  EXPECT_EQ(s.flipped_edges, 0u);
  EXPECT_NEAR(area(result.mesh), area(mesh), 1e-12);
}

TEST(Orient, RandomlyTurnedSphereComesOutward) {
  TriangleMesh mesh = sphere(8);
  mesh.normals.values = mesh.positions;
  mesh.normals.indices = mesh.triangles;
  std::mt19937 random(3);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (random() % 2) {
      std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
      std::swap(mesh.normals.indices[t][1], mesh.normals.indices[t][2]);
    }
  const double volume = signed_volume(sphere(8));
  const OrientResult result = orient(mesh);
  EXPECT_EQ(mesh_statistics(result.mesh).flipped_edges, 0u);
  EXPECT_NEAR(signed_volume(result.mesh), volume, 1e-9);
  EXPECT_EQ(result.closed, 1u);
  for (std::size_t t = 0; t < result.mesh.triangles.size(); ++t) {
    // Triangles that were reversed carried outward normals, which turning them over negates.
    const Vec3 n = result.mesh.normals.values[result.mesh.normals.indices[t][0]];
    const bool turned = result.mesh.triangles[t] != mesh.triangles[t];
    EXPECT_NEAR(dot(n, result.mesh.corner(t, 0)), turned ? -1 : 1, 1e-9);
  }
}

/// The first triangle, from which the others get their sense, is the odd one.
TEST(Orient, ASolidIsOrientedByTheVolumeThatItHasWhenItsTrianglesAgree) {
  for (TriangleMesh mesh : {sphere(4), reversed(sphere(4))}) {
    std::swap(mesh.triangles[0][1], mesh.triangles[0][2]);
    EXPECT_NEAR(signed_volume(orient(mesh).mesh), signed_volume(sphere(4)), 1e-9);
  }
}

TEST(Orient, InwardSolidTurnsButCavityStays) {
  EXPECT_NEAR(signed_volume(orient(reversed(cube())).mesh), 1, 1e-12);
  TriangleMesh inner = cube();
  for (Vec3& p : inner.positions) p = 0.25 * p + Vec3{0.3, 0.3, 0.3};
  EXPECT_NEAR(signed_volume(orient(joined(cube(2), reversed(inner))).mesh), 1 - 0.015625, 1e-12);
  // A solid within the cavity of another, twice as deep as the cavity, faces out again.
  TriangleMesh cavity = cube(), core = cube();
  for (Vec3& p : cavity.positions) p = 0.5 * p + Vec3{0.25, 0.25, 0.25};
  for (Vec3& p : core.positions) p = 0.25 * p + Vec3{0.3, 0.35, 0.4};
  const TriangleMesh nested = joined(joined(cube(2), reversed(cavity)), reversed(core));
  EXPECT_NEAR(signed_volume(orient(nested).mesh), 1 - 0.125 + 0.015625, 1e-12);
  const TriangleMesh beside = joined(cube(2), reversed(moved(inner, {5, 0, 0})));
  EXPECT_NEAR(signed_volume(orient(beside).mesh), 1 + 0.015625, 1e-12);
}

TEST(Orient, OpenSheetTakesTheMajority) {
  TriangleMesh mesh = grid(5, 5);
  std::swap(mesh.triangles[0][1], mesh.triangles[0][2]);  // the seed of the traversal is the odd one
  const OrientResult result = orient(mesh);
  EXPECT_EQ(result.reversed, 1u);
  EXPECT_EQ(result.mesh.triangles[1], mesh.triangles[1]);
}

TEST(Orient, MoebiusStripKeepsAConflict) { EXPECT_GE(orient(moebius(20)).conflicting_edges, 1u); }

TEST(Manifold, CubesSharingAnEdgePartIntoSolids) {
  const TriangleMesh mesh = voxels({{0, 0, 0}, {1, 1, 0}});
  EXPECT_EQ(mesh_statistics(mesh).nonmanifold_edges, 1u);
  const ManifoldResult result = split_nonmanifold(mesh);
  const MeshStatistics s = mesh_statistics(result.mesh);
  EXPECT_EQ(result.parted_edges, 1u);
  EXPECT_EQ(s.nonmanifold_edges, 0u);
  EXPECT_EQ(s.boundary_edges, 0u);
  EXPECT_EQ(s.components, 2u);
  EXPECT_NEAR(*s.volume_mm3, 2, 1e-4);
  EXPECT_GT(result.max_deviation_mm, 0);
  EXPECT_LT(result.max_deviation_mm, 1e-4);
}

TEST(Manifold, ThreeSheetsAtAnEdgePartIntoTwo) {
  TriangleMesh mesh = grid(2, 2);  // plus a fin over the middle line
  mesh.positions.push_back({1, 0, 1});
  mesh.positions.push_back({1, 1, 1});
  mesh.triangles.push_back({1, 4, 10});
  mesh.triangles.push_back({1, 10, 9});
  const ManifoldResult result = split_nonmanifold(mesh);
  const MeshStatistics s = mesh_statistics(result.mesh);
  EXPECT_EQ(s.nonmanifold_edges, 0u);
  EXPECT_EQ(s.components, 2u);
}

TEST(Manifold, SheetsTouchingInAPointGetTheirOwnVertex) {
  const TriangleMesh mesh = voxels({{0, 0, 0}, {1, 1, 1}});
  const ManifoldResult result = split_nonmanifold(mesh);
  EXPECT_EQ(result.added_vertices, 1u);
  EXPECT_EQ(result.mesh.positions.size(), mesh.positions.size() + 1);
  EXPECT_EQ(result.max_deviation_mm, 0);
}

TEST(Manifold, MoebiusStripIsCutOpen) {
  const ManifoldResult result = split_nonmanifold(orient(moebius(24)).mesh);
  const MeshStatistics s = mesh_statistics(result.mesh);
  EXPECT_EQ(s.flipped_edges, 0u);
  EXPECT_EQ(s.boundary_loops, 1u);
  EXPECT_EQ(s.genus, 0);
  EXPECT_EQ(s.components, 1u);
}

}  // namespace
}  // namespace papilla
