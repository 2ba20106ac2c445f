// SPDX-License-Identifier: MIT
#include "papilla/texture/relief_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "papilla/core/error.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

TEST(ReliefError, PlanesDoNotCountAndScalesOnlyOnce) {
  const HeightMap truth =
      test::make_relief(40, 30, 0.1, [](int x, int y) { return 0.1 * std::sin(0.6 * x) * std::cos(0.4 * y); });
  std::vector<double> tilted, doubled, negative;
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) {
      const double px = static_cast<double>(truth.at(x, y)) / 0.1;
      tilted.push_back(px + 0.3 * x - 0.1 * y + 5);
      doubled.push_back(2 * px);
      negative.push_back(-px);
    }
  EXPECT_NEAR(relief_error(tilted, truth).mean, 0, 1e-12);
  EXPECT_NEAR(relief_error(tilted, truth).correlation, 1, 1e-12);
  EXPECT_GT(relief_error(doubled, truth).mean, 0.1);
  EXPECT_NEAR(relief_error(doubled, truth).scaled_mean, 0, 1e-12);
  EXPECT_NEAR(relief_error(negative, truth).correlation, -1, 1e-12);
}

/// A wave along y that was not found beside one along x that was: both are as steep, half of the squares is missing.
TEST(ReliefError, SlopesAlongBothAxesCount) {
  constexpr double turn = 2 * std::numbers::pi / 12;
  const HeightMap truth = test::make_relief(
      48, 36, 0.1, [](int x, int y) { return 0.1 * (std::sin(turn * (x + 0.5)) + std::sin(turn * (y + 0.5))); });
  std::vector<double> along_x, along_y;
  for (int y = 0; y < 36; ++y)
    for (int x = 0; x < 48; ++x) {
      along_x.push_back(std::sin(turn * (x + 0.5)));
      along_y.push_back(std::sin(turn * (y + 0.5)));
    }
  EXPECT_NEAR(relief_error(along_x, truth).slope, std::sqrt(0.5), 0.02);
  EXPECT_NEAR(relief_error(along_y, truth).slope, std::sqrt(0.5), 0.02);
}

TEST(ReliefError, RefusesWhatCantBeCompared) {
  const HeightMap truth = test::make_relief(4, 4, 1, [](int x, int) { return x; });
  EXPECT_THROW(relief_error(std::vector<double>(15, 0.0), truth), InvalidInput);
  EXPECT_THROW(relief_error(std::vector<double>(16, std::nan("")), truth), InvalidInput);
  EXPECT_THROW(relief_error(std::vector<double>(16, 0.0), test::make_relief(4, 4, 1, [](int, int) { return 1.0; })),
               InvalidInput);
}

}  // namespace
}  // namespace papilla
