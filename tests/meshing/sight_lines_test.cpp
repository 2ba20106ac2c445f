// SPDX-License-Identifier: MIT
#include "papilla/meshing/sight_lines.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "papilla/core/error.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla {
namespace {

std::array<double, 16> shifted(double x, double y, double z) {
  return {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1};
}

TEST(SightLines, WallsHideFromBothSidesAndPointsOnThemAreSeen) {
  const TriangleMesh cube = test::cube(20);
  const SightLines sight(std::vector<PlacedMesh>{{&cube}});
  const Vec3 above{9, 11, 50}, within{10, 10, 10}, lid{8, 13, 20}, bottom{8, 13, 0};
  EXPECT_TRUE(sight.sees(above, lid));
  EXPECT_TRUE(sight.sees(within, lid));
  EXPECT_FALSE(sight.sees(above, bottom));
  EXPECT_FALSE(sight.sees(above, within));
  EXPECT_FALSE(sight.sees(within, above));
  EXPECT_TRUE(sight.sees(within, bottom));
  EXPECT_TRUE(sight.sees(above, above));
}

TEST(SightLines, PartsStandWhereTheyArePlacedAndGlassHidesNothing) {
  const TriangleMesh cube = test::cube(20);
  const Vec3 left{-10, 10, 10}, right{130, 10, 10};
  EXPECT_FALSE(SightLines(std::vector<PlacedMesh>{{&cube, shifted(50, 0, 0)}}).sees(left, right));
  EXPECT_TRUE(SightLines(std::vector<PlacedMesh>{{&cube, shifted(50, 50, 0)}}).sees(left, right));
  EXPECT_TRUE(SightLines(std::vector<PlacedMesh>{{&cube, shifted(50, 0, 0), false}}).sees(left, right));
}

TEST(SightLines, RefusesMeshesThatAreNone) {
  TriangleMesh bad = test::cube(20);
  bad.positions[3].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(SightLines(std::vector<PlacedMesh>{{&bad}}), InvalidInput);
  EXPECT_THROW(SightLines(std::vector<PlacedMesh>{{nullptr}}), InvalidInput);
}

}  // namespace
}  // namespace papilla
