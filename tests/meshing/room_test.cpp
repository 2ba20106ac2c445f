// SPDX-License-Identifier: MIT
#include "room.hpp"

#include <gtest/gtest.h>

#include "papilla_test/shapes.hpp"

namespace papilla::detail {
namespace {

TEST(PlacesAround, HaveHalfTheScoreOfThePointOrOfTheBestOfThem) {
  const TriangleMesh far = papilla::test::plane(1, 1, 1, 1);
  const std::vector<PlacedMesh> parts{{&far}};
  const PlacedBvh bvh(place(parts, "test"));
  const Vec3 room{0, 0, 100}, low{0, 0, 110}, high{0, 0, 120}, none{0, 0, 130};
  const std::vector<Place> places{{room, 1, 10, 10}, {low, 1, 4, 4}, {high, 1, 6, 6}, {none, 0, 0, 0}};
  EXPECT_EQ(places_around(bvh, places, room, 7), std::vector<Vec3>{high}) << "of a place";
  const std::vector<Place> others(places.begin() + 1, places.end());
  EXPECT_EQ(places_around(bvh, others, room, 7), (std::vector<Vec3>{low, high})) << "of any other point";
  EXPECT_EQ(places_around(bvh, others, room, 1), std::vector<Vec3>{low});
}

}  // namespace
}  // namespace papilla::detail
