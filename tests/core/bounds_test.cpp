// SPDX-License-Identifier: MIT
#include "papilla/core/bounds.hpp"

#include <gtest/gtest.h>

namespace papilla {
namespace {

TEST(Bounds, EmptyHasNoSize) {
  const Bounds3 box;
  EXPECT_TRUE(box.is_empty());
  EXPECT_EQ(box.size(), Vec3{});
  EXPECT_EQ(box.middle(), Vec3{});
  EXPECT_EQ(box.diagonal(), 0);
}

TEST(Bounds, HoldsWhatWasAdded) {
  Bounds3 box;
  box.add(Vec3{1, -2, 3});
  EXPECT_FALSE(box.is_empty());
  EXPECT_EQ(box.diagonal(), 0);
  box.add(Vec3{-1, 1, 9});
  EXPECT_EQ(box.low, (Vec3{-1, -2, 3}));
  EXPECT_EQ(box.high, (Vec3{1, 1, 9}));
  EXPECT_EQ(box.middle(), (Vec3{0, -0.5, 6}));
  EXPECT_EQ(box.diagonal(), 7);  // 2, 3, 6
  Bounds3 other;
  other.add(Vec3{0, 5, 4});
  box.add(other);
  EXPECT_EQ(box.high, (Vec3{1, 5, 9}));
  box.add(Bounds3{});
  EXPECT_EQ(box.low, (Vec3{-1, -2, 3}));
}

TEST(Bounds, OfThePlane) {
  Bounds2 box;
  box.add(Vec2{3, 0});
  box.add(Vec2{0, 4});
  EXPECT_EQ(box.diagonal(), 5);
  EXPECT_TRUE(box.overlaps(Bounds2{{3.5, 4}, {6, 6}}, 0.5));
  EXPECT_FALSE(box.overlaps(Bounds2{{3.5, 4}, {6, 6}}, 0.4));
  EXPECT_FALSE(box.overlaps(Bounds2{{0, 5}, {3, 6}}, 0.5));
}

TEST(Bounds, OverlapsWithinAMarginAlongEveryAxis) {
  const Bounds3 box{{0, 10, 200}, {1, 14, 209}};
  const auto moved = [&](Vec3 by) { return Bounds3{box.low + by, box.high + by}; };
  for (const Vec3& apart : {Vec3{1.5, 0, 0}, Vec3{0, 4.5, 0}, Vec3{0, 0, 9.5}}) {
    for (const double sense : {-1.0, 1.0}) {
      EXPECT_TRUE(box.overlaps(moved(sense * apart), 0.5));
      EXPECT_FALSE(box.overlaps(moved(sense * apart), 0.4));
    }
  }
}

TEST(Bounds, ContainsByAMargin) {
  const Bounds3 box{{0, 0, 0}, {4, 4, 4}}, inner{{1, 1, 1}, {3, 3, 3}};
  EXPECT_TRUE(box.contains(inner));
  EXPECT_TRUE(box.contains(inner, 0.9));
  EXPECT_FALSE(box.contains(inner, 1));
  EXPECT_FALSE(inner.contains(box));
  EXPECT_FALSE(box.contains(Bounds3{{1, 1, 1}, {3, 3, 4}}));
}

}  // namespace
}  // namespace papilla
