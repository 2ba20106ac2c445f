// SPDX-License-Identifier: MIT
#include "papilla/texture/primitive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "papilla/core/error.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

TEST(Primitive, WholePixelPeriodsAreExact) {
  const GreyImage cell = test::noise_image(9, 7, 3, 8);
  const GreyImage image =
      test::make_image(63, 49, [&](int x, int y) { return static_cast<double>(cell.at(x % 9, y % 7)); });
  const SymmetricPart part = symmetric_part(image, {Vec2{9, 0}, Vec2{0, 7}});
  ASSERT_EQ(part.primitive.width, 9);
  ASSERT_EQ(part.primitive.height, 7);
  for (std::size_t i = 0; i < cell.pixels.size(); ++i) EXPECT_NEAR(part.primitive.pixels[i], cell.pixels[i], 1e-6);
  for (const float rest : part.residual.pixels) EXPECT_NEAR(rest, 0, 1e-6);
  EXPECT_EQ(part.cells, 49);
  EXPECT_NEAR(part.explained_variance, 1, 1e-9);
}

TEST(Primitive, ObliqueSubPixelPeriodsAreFollowed) {
  const Vec2 a{17.3, 2.1}, b{-3.7, 19.6};
  const double area = cross(a, b);
  const GreyImage image = test::make_image(150, 140, [&](int x, int y) {
    const Vec2 p{static_cast<double>(x), static_cast<double>(y)};
    return 0.5 + 0.3 * std::cos(2 * std::numbers::pi * cross(p, b) / area) *
                     std::sin(2 * std::numbers::pi * cross(a, p) / area);
  });
  EXPECT_GT(symmetric_part(image, {a, b}).explained_variance, 0.999);
  // The same cell with wrong vectors explains little.
  EXPECT_LT(symmetric_part(image, {Vec2{16, 0}, Vec2{0, 21}}).explained_variance, 0.2);
}

TEST(Primitive, NoiseIsNotExplained) {
  EXPECT_LT(symmetric_part(test::noise_image(128, 128, 5), {Vec2{40, 3}, Vec2{-2, 50}}).explained_variance, 0.05);
}

TEST(Primitive, RefusesVectorsThatSpanNoCell) {
  const GreyImage image = test::noise_image(32, 32, 1);
  EXPECT_THROW(symmetric_part(image, {Vec2{5, 5}, Vec2{10, 10}}), InvalidInput);
  EXPECT_THROW(symmetric_part(image, {Vec2{1, 0}, Vec2{0, 8}}), InvalidInput);
  EXPECT_THROW(symmetric_part(image, {Vec2{40, 0}, Vec2{0, 8}}), InvalidInput);
  EXPECT_THROW(symmetric_part(image, {Vec2{std::nan(""), 0}, Vec2{0, 8}}), InvalidInput);
}

}  // namespace
}  // namespace papilla
