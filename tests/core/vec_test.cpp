// SPDX-License-Identifier: MIT
#include "papilla/core/vec.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace papilla {
namespace {

TEST(Vec, ProductsByHand) {
  constexpr Vec3 a{2, -3, 5}, b{7, 11, -13};
  EXPECT_EQ(dot(a, b), 14 - 33 - 65);
  EXPECT_EQ(cross(a, b), (Vec3{39 - 55, 35 + 26, 22 + 21}));
  EXPECT_EQ(cross(Vec2{2, -3}, Vec2{7, 11}), 22 + 21);
  EXPECT_EQ(norm(Vec3{2, -3, 6}), 7);
  EXPECT_EQ(normalized(Vec3{0, 0, -4}), (Vec3{0, 0, -1}));
  EXPECT_EQ(normalized(Vec3{}), Vec3{});
}

TEST(Vec, IsFiniteWhenEveryCoordinateIs) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN(), endless = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(is_finite(Vec3{1e308, -1e308, 0}));
  for (const double bad : {none, endless, -endless}) {
    for (const Vec3& a : {Vec3{bad, 0, 0}, Vec3{0, bad, 0}, Vec3{0, 0, bad}}) EXPECT_FALSE(is_finite(a));
    for (const Vec2& a : {Vec2{bad, 0}, Vec2{0, bad}}) EXPECT_FALSE(is_finite(a));
  }
}

TEST(Vec, CrossProductOfAnyTwo) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int i = 0; i < 100; ++i) {
    const Vec3 a{any(random), any(random), any(random)}, b{any(random), any(random), any(random)}, c = cross(a, b);
    EXPECT_NEAR(dot(c, a), 0, 1e-15);
    EXPECT_NEAR(dot(c, b), 0, 1e-15);
    EXPECT_NEAR(dot(c, c), dot(a, a) * dot(b, b) - dot(a, b) * dot(a, b), 1e-14);  // Lagrange's identity
  }
}

}  // namespace
}  // namespace papilla
