// SPDX-License-Identifier: MIT
#include "papilla/texture/stein_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

/// E[(X(s) − X(t))²] over many surfaces against r^(2H): near, far and diagonal pairs.
class SteinVariogram : public testing::TestWithParam<double> {};

TEST_P(SteinVariogram, IsTheOneOfFractionalBrownianMotion) {
  const double hurst = GetParam();
  constexpr int n = 33, k_surfaces = 400;
  struct Pair {
    int dx, dy;
    double sum = 0;
    int count = 0;
  };
  std::vector<Pair> pairs = {{1, 0}, {0, 1}, {3, 2}, {0, 8}, {16, 16}, {32, 0}, {32, 32}};
  for (std::uint64_t seed = 1; seed <= k_surfaces; ++seed) {
    const HeightGrid surface = brownian_surface_exact({n, hurst, seed});
    for (Pair& pair : pairs)
      for (int y = 0; y + pair.dy < n; y += 8)
        for (int x = 0; x + pair.dx < n; x += 8) {
          const double d = surface.at(x + pair.dx, y + pair.dy) - surface.at(x, y);
          pair.sum += d * d;
          ++pair.count;
        }
  }
  for (const Pair& pair : pairs) {
    const double expected = std::pow(std::hypot(pair.dx, pair.dy), 2 * hurst);
    // The corner pair alone has a standard error of √(2/400) = 7 %.
    EXPECT_NEAR(pair.sum / pair.count / expected, 1, 0.25) << pair.dx << ", " << pair.dy;
  }
}

INSTANTIATE_TEST_SUITE_P(Hurst, SteinVariogram, testing::Values(0.2, 0.5, 0.75, 0.9));

TEST(SteinSurface, DependsOnTheSeedOnly) {
  const BrownianSurfaceOptions options{65, 0.4, 9};
  EXPECT_EQ(brownian_surface_exact(options).heights, brownian_surface_exact(options).heights);
  EXPECT_NE(brownian_surface_exact(options).heights, brownian_surface_exact({65, 0.4, 10}).heights);
}

TEST(SteinSurface, GreyImageIsStretchedAndRounded) {
  const GreyImage image = to_grey_image(brownian_surface_exact({65, 0.5, 1}), 8);
  EXPECT_EQ(image.bits, 8);
  const auto [low, high] = std::minmax_element(image.pixels.begin(), image.pixels.end());
  EXPECT_EQ(*low, 0);
  EXPECT_EQ(*high, 1);
  for (const float value : image.pixels) EXPECT_NEAR(255 * value, std::round(255 * value), 1e-4);
  EXPECT_THROW(to_grey_image(HeightGrid{}), InvalidInput);
  EXPECT_THROW(to_grey_image(brownian_surface_exact({5, 0.5, 1}), 12), InvalidInput);
}

TEST(SteinSurface, RefusesBadOptions) {
  EXPECT_THROW(brownian_surface_exact({1, 0.5, 1}), InvalidInput);
  EXPECT_THROW(brownian_surface_exact({5000, 0.5, 1}), InvalidInput);
  EXPECT_THROW(brownian_surface_exact({65, 0, 1}), InvalidInput);
  EXPECT_THROW(brownian_surface_exact({65, std::nan(""), 1}), InvalidInput);
}

}  // namespace
}  // namespace papilla
