// SPDX-License-Identifier: MIT
#include "trs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace papilla {
namespace {

Transform compose(const Trs& trs) {
  const auto [x, y, z, w] = trs.rotation;
  const Vec3 s = trs.scale, t = trs.translation;
  return {s.x * (1 - 2 * (y * y + z * z)),
          s.y * 2 * (x * y - z * w),
          s.z * 2 * (x * z + y * w),
          t.x,
          s.x * 2 * (x * y + z * w),
          s.y * (1 - 2 * (x * x + z * z)),
          s.z * 2 * (y * z - x * w),
          t.y,
          s.x * 2 * (x * z - y * w),
          s.y * 2 * (y * z + x * w),
          s.z * (1 - 2 * (x * x + y * y)),
          t.z,
          0,
          0,
          0,
          1};
}

void expect_round_trip(const Transform& transform) {
  const auto trs = decompose(transform);
  ASSERT_TRUE(trs);
  const auto [x, y, z, w] = trs->rotation;
  EXPECT_NEAR(x * x + y * y + z * z + w * w, 1, 1e-12);
  const Transform again = compose(*trs);
  for (std::size_t i = 0; i < 16; ++i) EXPECT_NEAR(again[i], transform[i], 1e-12) << i;
}

TEST(Trs, RandomTransformsComeBack) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 500; ++i) {
    Trs trs;
    double length = 0;
    for (double& q : trs.rotation) {
      q = normal(random);
      length += q * q;
    }
    for (double& q : trs.rotation) q /= std::sqrt(length);
    trs.scale = {normal(random), normal(random), normal(random)};
    trs.translation = {normal(random), normal(random), normal(random)};
    expect_round_trip(compose(trs));
  }
}

TEST(Trs, ScalesOfZeroComeBack) {
  for (int mask = 0; mask < 8; ++mask) {
    Trs trs;
    trs.rotation = {0.5, 0.5, 0.5, 0.5};
    trs.scale = {mask & 1 ? 2.0 : 0, mask & 2 ? 3.0 : 0, mask & 4 ? -1.0 : 0};
    expect_round_trip(compose(trs));
  }
}

TEST(Trs, IdentityIsNeutral) {
  const auto trs = decompose(k_identity);
  EXPECT_EQ(trs->rotation, (std::array<double, 4>{0, 0, 0, 1}));
  EXPECT_EQ(trs->scale, (Vec3{1, 1, 1}));
}

TEST(Trs, ShearIsRefused) {
  Transform shear = k_identity;
  shear[1] = 0.01;
  EXPECT_FALSE(decompose(shear));
}

}  // namespace
}  // namespace papilla
