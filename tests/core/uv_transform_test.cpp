// SPDX-License-Identifier: MIT
#include "papilla/core/uv_transform.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace papilla {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix result{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) result[i][j] += a[i][k] * b[k][j];
  return result;
}

/// The matrices of the sample code in the specification of KHR_texture_transform, on uv with v down.
Vec2 by_specification(const UvTransform& t, Vec2 uv) {
  const double c = std::cos(t.rotation), s = std::sin(t.rotation);
  const Matrix translation = {{{1, 0, t.offset.x}, {0, 1, t.offset.y}, {0, 0, 1}}};
  const Matrix rotation = {{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}};
  const Matrix scale = {{{t.scale.x, 0, 0}, {0, t.scale.y, 0}, {0, 0, 1}}};
  const Matrix all = product(product(translation, rotation), scale);
  return {all[0][0] * uv.x + all[0][1] * uv.y + all[0][2], all[1][0] * uv.x + all[1][1] * uv.y + all[1][2]};
}

TEST(UvTransform, AgreesWithTheSpecification) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(-3, 3);
  for (int k = 0; k < 100; ++k) {
    const UvTransform transform{{number(random), number(random)}, number(random), {number(random), number(random)}};
    const Vec2 uv{number(random), number(random)};
    const Vec2 expected = by_specification(transform, {uv.x, 1 - uv.y});
    const Vec2 moved = transform_uv(transform, uv);
    EXPECT_NEAR(moved.x, expected.x, 1e-13);
    EXPECT_NEAR(moved.y, 1 - expected.y, 1e-13);
  }
}

TEST(UvTransform, TheDefaultChangesNothing) {
  EXPECT_EQ(transform_uv({}, {0.25, -0.5}), (Vec2{0.25, -0.5}));
  EXPECT_EQ(UvTransform().rows(512, 256), (std::array<Vec2, 2>{Vec2{512, 0}, Vec2{0, 256}}));
}

TEST(UvTransform, RowsGiveTexels) {
  const UvTransform turned{{0, 0}, std::numbers::pi / 2, {2, 4}};
  const auto rows = turned.rows(100, 50);
  EXPECT_NEAR(rows[0].x, 0, 1e-13);
  EXPECT_NEAR(rows[0].y, 400, 1e-13);
  EXPECT_NEAR(rows[1].x, -100, 1e-13);
  EXPECT_NEAR(rows[1].y, 0, 1e-13);
}

}  // namespace
}  // namespace papilla
