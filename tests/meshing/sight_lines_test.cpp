// SPDX-License-Identifier: MIT
#include "papilla/meshing/sight_lines.hpp"

#include <gtest/gtest.h>

#include <cmath>
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

/// Slivers along the diagonals of space lie in rows of boxes, which must hold all of them: the side of two edges and
/// that of one, whether they rise or fall.
TEST(SightLines, SliversHideWhatLiesBehindAllOfThem) {
  const auto share = [](int i, double step) { return i * step - std::floor(i * step); };
  for (const double side : {1.0, -1.0})
    for (const bool turned : {false, true}) {
      TriangleMesh mesh = test::plane(10, 10, 12, 12);  // As many boxes more as there are triangles.
      const auto first = static_cast<Index>(mesh.positions.size());
      const Vec3 a{200, 0, 0}, b{200 + side * 100, 100, 100}, c{200 + side * 50, 50, 54};
      mesh.positions.insert(mesh.positions.end(), {a, b, c});
      mesh.triangles.push_back(turned ? Triangle{first, first + 2, first + 1} : Triangle{first, first + 1, first + 2});
      const SightLines sight(std::vector<PlacedMesh>{{&mesh}});
      const Vec3 half = 0.5 * normalized(cross(b - a, c - a));
      int seen = 0;
      for (int i = 1; i <= 500; ++i) {
        double u = share(i, 0.7548776662), v = share(i, 0.5698402910);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const Vec3 p = a + u * (b - a) + v * (c - a);
        seen += sight.sees(p + half, p - half) ? 1 : 0;
      }
      EXPECT_EQ(seen, 0);
    }
}

TEST(SightLines, RefusesMeshesThatAreNone) {
  TriangleMesh bad = test::cube(20);
  bad.positions[3].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(SightLines(std::vector<PlacedMesh>{{&bad}}), InvalidInput);
  EXPECT_THROW(SightLines(std::vector<PlacedMesh>{{nullptr}}), InvalidInput);
}

}  // namespace
}  // namespace papilla
