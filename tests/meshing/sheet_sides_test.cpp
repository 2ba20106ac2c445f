// SPDX-License-Identifier: MIT
#include "papilla/meshing/sheet_sides.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "papilla/core/error.hpp"
#include "papilla/meshing/orient.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla {
namespace {

using World = std::array<double, 16>;

World shifted(double x, double y, double z) { return {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1}; }

constexpr double k_side = 1000;

/// A square wall of the room [0, 1000]^3: corner, edge directions a and b; its front is towards a x b.
TriangleMesh wall(Vec3 corner, Vec3 a, Vec3 b) {
  TriangleMesh mesh = test::plane(k_side, k_side, 4, 4);
  for (Vec3& p : mesh.positions) p = corner + p.x * a + p.y * b;
  return mesh;
}

/// The six walls of a room, fronts to its inside.
std::vector<TriangleMesh> room() {
  const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  return {wall({}, x, y), wall({0, 0, k_side}, y, x), wall({}, y, z), wall({k_side, 0, 0}, z, y),
          wall({}, z, x), wall({0, k_side, 0}, x, z)};
}

void turn_all(TriangleMesh& mesh) { turn_triangles(mesh, std::vector<std::uint8_t>(mesh.triangles.size(), 1)); }

std::vector<PlacedMesh> placed(const std::vector<TriangleMesh>& meshes) {
  std::vector<PlacedMesh> uses;
  for (const TriangleMesh& mesh : meshes) uses.push_back({&mesh});
  return uses;
}

const SheetSide& only_sheet(const SheetSides& sides, std::size_t mesh) {
  EXPECT_EQ(sides.meshes.at(mesh).sheets.size(), 1u);
  return sides.meshes[mesh].sheets.at(0);
}

TEST(SheetSides, WallsOfARoomThatFaceOutAreFound) {
  std::vector<TriangleMesh> walls = room();
  turn_all(walls[1]);
  turn_all(walls[4]);
  const SheetSides sides = find_sheet_sides(placed(walls));
  EXPECT_EQ(sides.viewpoint, Viewpoint::room);
  EXPECT_GT(sides.enclosure, 0.99);
  for (const double at : {sides.eye.x, sides.eye.y, sides.eye.z}) EXPECT_NEAR(at, k_side / 2, k_side / 4);
  for (std::size_t m = 0; m < walls.size(); ++m) {
    EXPECT_EQ(only_sheet(sides, m).reason, SideReason::seen) << m;
    EXPECT_EQ(only_sheet(sides, m).faces_away, m == 1 || m == 4) << m;
    EXPECT_EQ(sides.meshes[m].turn.empty(), m != 1 && m != 4) << m;
    turn_triangles(walls[m], sides.meshes[m].turn.empty() ? std::vector<std::uint8_t>(walls[m].triangles.size(), 0)
                                                          : sides.meshes[m].turn);
  }
  const SheetSides again = find_sheet_sides(placed(walls));
  for (std::size_t m = 0; m < walls.size(); ++m) EXPECT_FALSE(only_sheet(again, m).faces_away) << m;
}

TEST(SheetSides, WhatWasTurnedIsNotTurnedAgain) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> at(0, k_side);
  std::size_t turned = 0;
  for (int scene = 0; scene < 20; ++scene) {
    TriangleMesh soup;
    for (Index t = 0; t < 60; ++t) {
      for (int corner = 0; corner < 3; ++corner) soup.positions.push_back({at(random), at(random), at(random)});
      soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    const SheetSides sides = find_sheet_sides({{{&soup}}});
    if (!sides.meshes[0].turn.empty()) turn_triangles(soup, sides.meshes[0].turn);
    turned += !sides.meshes[0].turn.empty();
    const SheetSides again = find_sheet_sides({{{&soup}}});
    EXPECT_TRUE(again.meshes[0].turn.empty()) << scene;
    EXPECT_EQ(again.eye, sides.eye) << scene;
  }
  EXPECT_GT(turned, 10U);
}

TEST(SheetSides, AGivenPointCountsWhereverMostWallsFace) {
  std::vector<TriangleMesh> walls = room();
  for (std::size_t m = 0; m < 5; ++m) turn_all(walls[m]);
  const SheetSides sides = find_sheet_sides(placed(walls), {.inside = Vec3{300, 400, 500}});
  EXPECT_EQ(sides.viewpoint, Viewpoint::inside);
  for (std::size_t m = 0; m < walls.size(); ++m) EXPECT_EQ(only_sheet(sides, m).faces_away, m < 5) << m;
}

TEST(SheetSides, ViewVolumesAreEyes) {
  std::vector<TriangleMesh> walls = room();
  turn_all(walls[2]);
  const SheetSides sides = find_sheet_sides(placed(walls), {.inside = {}, .view = {SphereVolume{{500, 500, 500}, 50}}});
  EXPECT_EQ(sides.viewpoint, Viewpoint::view);
  for (std::size_t m = 0; m < walls.size(); ++m) EXPECT_EQ(only_sheet(sides, m).faces_away, m == 2) << m;
}

TEST(SheetSides, AnOpenObjectFacesThoseAroundIt) {
  TriangleMesh ball = test::spherical_cap(50, 0.9 * std::numbers::pi, 12, 24);
  const SheetSides outward = find_sheet_sides(placed({ball}));
  EXPECT_EQ(outward.viewpoint, Viewpoint::around);
  EXPECT_EQ(outward.meshes[0].sheets[0].reason, SideReason::seen);
  EXPECT_FALSE(outward.meshes[0].sheets[0].faces_away);
  EXPECT_GT(outward.meshes[0].sheets[0].front_share, 0.8);
}

TEST(SheetSides, ASheetThatIsSeenFromBothSidesHasNone) {
  const std::vector<TriangleMesh> alone{test::plane(100, 100, 2, 2)};
  const SheetSides sides = find_sheet_sides(placed(alone));
  EXPECT_EQ(only_sheet(sides, 0).reason, SideReason::both_sides_seen);
  EXPECT_NEAR(only_sheet(sides, 0).front_share, 0.5, 0.01);
  EXPECT_TRUE(sides.meshes[0].turn.empty());

  std::vector<TriangleMesh> meshes = room();
  meshes.push_back(test::plane(200, 200, 2, 2));
  for (Vec3& p : meshes.back().positions) p = p + Vec3{400, 400, 500};
  const SheetSides screen =
      find_sheet_sides(placed(meshes), {.inside = {}, .view = {BoxVolume{{300, 300, 300}, {700, 700, 700}}}});
  EXPECT_EQ(only_sheet(screen, 6).reason, SideReason::both_sides_seen);
  EXPECT_EQ(only_sheet(screen, 0).reason, SideReason::seen);
}

TEST(SheetSides, AMoebiusStripHasNoSide) {
  const std::vector<TriangleMesh> strip{test::moebius_strip(50, 20, 24, 2)};
  const SheetSides sides = find_sheet_sides(placed(strip));
  EXPECT_EQ(only_sheet(sides, 0).reason, SideReason::non_orientable);
  EXPECT_TRUE(only_sheet(sides, 0).is_ambiguous());
  EXPECT_TRUE(sides.meshes[0].turn.empty());
}

/// Half of a floor lies within a closed block, where nobody sees it, and is turned over.
TEST(SheetSides, AHiddenSheetContinuesItsNeighbour) {
  TriangleMesh seen = test::plane(100, 100, 3, 3), hidden = test::plane(100, 100, 5, 5), block = test::cube(100);
  for (Vec3& p : hidden.positions) p.x += 100;
  for (Vec3& p : block.positions) p = {100 + 1.1 * p.x, -5 + 1.1 * p.y, p.z - 50};
  turn_all(hidden);
  const std::vector<TriangleMesh> meshes{seen, hidden, block};
  const SheetSides sides = find_sheet_sides(placed(meshes), {.inside = Vec3{50, 50, 80}});
  EXPECT_EQ(only_sheet(sides, 0).reason, SideReason::seen);
  EXPECT_FALSE(only_sheet(sides, 0).faces_away);
  EXPECT_EQ(only_sheet(sides, 1).reason, SideReason::neighbour);
  EXPECT_TRUE(only_sheet(sides, 1).faces_away);
  EXPECT_TRUE(sides.meshes[2].sheets.empty());

  TriangleMesh apart = hidden;
  for (Vec3& p : apart.positions) p.x += 5;
  const std::vector<TriangleMesh> with_gap{seen, apart, block};
  EXPECT_EQ(only_sheet(find_sheet_sides(placed(with_gap), {.inside = Vec3{50, 50, 80}}), 1).reason, SideReason::unseen);
}

/// A strip on a block is seen from above. A plate within another block continues it, and a floor within a third one
/// both, each along 6 % of its border: that of the plate is known a wave later.
TEST(SheetSides, ASheetContinuesSeveralTogether) {
  const auto moved = [](TriangleMesh mesh, Vec3 by) {
    for (Vec3& p : mesh.positions) p = p + by;
    return mesh;
  };
  const auto box = [](Vec3 low, Vec3 size) {
    TriangleMesh mesh = test::cube(1);
    for (Vec3& p : mesh.positions) p = low + Vec3{p.x * size.x, p.y * size.y, p.z * size.z};
    return mesh;
  };
  TriangleMesh floor = moved(test::plane(100, 100, 16, 16), {100, 0, 0});
  turn_all(floor);
  const std::vector<TriangleMesh> meshes{test::plane(100, 25, 16, 4),
                                         moved(test::plane(25, 25, 4, 4), {75, 25, 0}),
                                         floor,
                                         box({0, 0, -0.02}, {100, 25, 0.015}),
                                         box({75, 25, -0.02}, {25, 25.1, 0.025}),
                                         box({100, -5, -0.005}, {110, 110, 0.025})};
  const SheetSides sides = find_sheet_sides(placed(meshes));
  ASSERT_EQ(sides.viewpoint, Viewpoint::around);
  EXPECT_EQ(only_sheet(sides, 0).reason, SideReason::seen);
  EXPECT_FALSE(only_sheet(sides, 0).faces_away);
  EXPECT_EQ(only_sheet(sides, 1).reason, SideReason::neighbour);
  EXPECT_FALSE(only_sheet(sides, 1).faces_away);
  EXPECT_EQ(only_sheet(sides, 2).reason, SideReason::neighbour);
  EXPECT_TRUE(only_sheet(sides, 2).faces_away);
}

TEST(SheetSides, UsesOfOneMeshVoteAndMirroredOnesAsTheyAreDrawn) {
  const World mirror{-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  TriangleMesh door = wall({-k_side, 0, 0}, {0, 1, 0}, {0, 0, 1});  // Looks to +x, where the eye is.
  const SheetSideOptions eye{.inside = Vec3{0, 500, 500}};
  for (const bool turned : {false, true}) {
    const SheetSides sides = find_sheet_sides(std::vector<PlacedMesh>{{&door}, {&door, mirror}}, eye);
    ASSERT_EQ(sides.meshes.size(), 1u);
    EXPECT_EQ(only_sheet(sides, 0).reason, SideReason::seen);
    EXPECT_EQ(only_sheet(sides, 0).faces_away, turned);
    turn_all(door);
  }
  const SheetSides moved = find_sheet_sides(std::vector<PlacedMesh>{{&door}, {&door, shifted(2 * k_side, 0, 0)}}, eye);
  EXPECT_EQ(only_sheet(moved, 0).reason, SideReason::both_sides_seen);
}

TEST(SheetSides, TrianglesThatRunAgainstTheirSheetAreTurned) {
  std::vector<TriangleMesh> floor{test::plane(100, 100, 4, 4)};
  std::swap(floor[0].triangles[7][1], floor[0].triangles[7][2]);
  const SheetSides sides = find_sheet_sides(placed(floor), {.inside = Vec3{50, 50, 50}});
  EXPECT_FALSE(only_sheet(sides, 0).faces_away);
  ASSERT_EQ(sides.meshes[0].turn.size(), 32u);
  EXPECT_EQ(std::count(sides.meshes[0].turn.begin(), sides.meshes[0].turn.end(), 1), 1);
  EXPECT_EQ(sides.meshes[0].turn[7], 1);
}

TEST(SheetSides, ClosedSurfacesAndDoubleSheetsAreLeftAlone) {
  TriangleMesh sheet = test::plane(10, 10, 2, 2);
  const Values<Triangle> front = sheet.triangles;
  for (const Triangle& t : front) sheet.triangles.push_back({t[0], t[2], t[1]});
  sheet.uv = {};
  TriangleMesh touching = test::cube(10);  // Two cubes that share an edge, which has four triangles.
  const TriangleMesh other = test::cube(10);
  for (const Vec3& p : other.positions) touching.positions.push_back(p + Vec3{10, 10, 0});
  for (const Triangle& t : other.triangles) touching.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  const std::vector<TriangleMesh> meshes{test::cube(10), sheet, touching};
  const SheetSides sides = find_sheet_sides(placed(meshes));
  EXPECT_EQ(sides.viewpoint, Viewpoint::none);
  for (const MeshSheets& mesh : sides.meshes) EXPECT_TRUE(mesh.sheets.empty());
}

TEST(SheetSides, TheNumberOfThreadsDoesNotMatter) {
  std::vector<TriangleMesh> walls = room();
  turn_all(walls[3]);
  const auto run = [&](std::size_t threads) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    return find_sheet_sides(placed(walls));
  };
  const SheetSides one = run(1), two = run(2);
  EXPECT_EQ(one.eye, two.eye);
  for (std::size_t m = 0; m < walls.size(); ++m) {
    EXPECT_EQ(only_sheet(one, m).front_share, only_sheet(two, m).front_share);
    EXPECT_EQ(one.meshes[m].turn, two.meshes[m].turn);
  }
}

TEST(SheetSides, BadInputIsRefused) {
  const TriangleMesh mesh = test::plane(1, 1, 1, 1);
  const std::vector<PlacedMesh> uses{{&mesh}}, missing{{}};
  EXPECT_THROW(find_sheet_sides(missing), InvalidInput);
  EXPECT_THROW(find_sheet_sides(uses, {.inside = Vec3{0, std::numeric_limits<double>::quiet_NaN(), 0}}), InvalidInput);
  EXPECT_THROW(find_sheet_sides(uses, {.inside = {}, .view = {SphereVolume{{0, 0, 0}, -1}}}), InvalidInput);
  TriangleMesh turned = mesh;
  EXPECT_THROW(turn_triangles(turned, {1}), InvalidInput);
}

}  // namespace
}  // namespace papilla
