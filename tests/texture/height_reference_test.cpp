// SPDX-License-Identifier: MIT
#include "papilla/texture/height_reference.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "papilla/core/error.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

std::vector<double> heights_of(int width, int height, const std::function<double(int, int)>& px) {
  std::vector<double> heights;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) heights.push_back(px(x, y));
  return heights;
}

TEST(HeightReference, RulerAndShadow) {
  EXPECT_DOUBLE_EQ(pitch_of_ruler(10, {3, 4}, {63, 84}), 0.1);
  EXPECT_THROW(pitch_of_ruler(10, {3, 4}, {3, 4}), InvalidInput);
  EXPECT_THROW(pitch_of_ruler(-1, {3, 4}, {9, 4}), InvalidInput);
  EXPECT_NEAR(height_of_shadow({0, 0}, {6, 8}, {3, 0, 4}, 0.05), 10 * 0.05 * 4 / 3, 1e-12);
  EXPECT_THROW(height_of_shadow({0, 0}, {6, 8}, {0, 0, 1}, 0.05), InvalidInput);
}

TEST(HeightReference, GridOfThePicture) {
  const GreyImage grid = test::make_image(160, 120, [](int x, int y) { return x % 20 < 2 || y % 20 < 2 ? 0.1 : 0.9; });
  EXPECT_NEAR(pitch_of_grid(grid, 5), 0.25, 0.002);
  EXPECT_THROW(pitch_of_grid(test::noise_image(160, 120, 3), 5), InvalidInput);
}

TEST(HeightReference, StepScalesHeights) {
  const auto heights = heights_of(40, 30, [](int x, int) { return x < 20 ? 1.0 : 5.0; });
  const PixelRelief relief{40, 30, heights};
  EXPECT_DOUBLE_EQ(scale_of_step(relief, 0.2, {8, 10}, {30, 12}), 0.05);
  EXPECT_THROW(scale_of_step(relief, 0.2, {30, 12}, {8, 10}), InvalidInput);
  EXPECT_THROW(scale_of_step(relief, 0.2, {8, 10}, {45, 12}), InvalidInput);
}

/// Between four pixels heights are bilinear: exact for a saddle, along any line.
TEST(HeightReference, ProfilesMayRunObliquely) {
  const auto heights = heights_of(60, 40, [](int x, int y) { return 0.01 * x * y; });
  ProfileLine profile;
  for (int i = 0; i <= 50; ++i) {
    const double x = 5.3 + 0.91 * i, y = 7.6 + 0.47 * i;
    profile.along_mm.push_back(0.1 * i);
    profile.height_mm.push_back(0.04 * 0.01 * x * y);
  }
  const ProfileFit fit = fit_profile({60, 40, heights}, profile, {5.3, 7.6}, {5.3 + 0.91 * 50, 7.6 + 0.47 * 50});
  EXPECT_NEAR(fit.scale, 0.04, 1e-6);
  EXPECT_NEAR(fit.rms_mm, 0, 1e-6);
}

TEST(HeightReference, ProfileScalesHeightsWhateverTiltAndShift) {
  const auto heights = heights_of(60, 40, [](int x, int y) { return 2 * std::sin(0.3 * x) + 0.1 * y; });
  const PixelRelief relief{60, 40, heights};
  ProfileLine profile;
  for (int i = 0; i <= 50; ++i) {
    const double x = 5 + i;
    profile.along_mm.push_back(0.1 * i);
    profile.height_mm.push_back(0.04 * 2 * std::sin(0.3 * x) + 7 - 0.02 * i);
  }
  const ProfileFit fit = fit_profile(relief, profile, {5, 20}, {55, 20});
  EXPECT_NEAR(fit.scale, 0.04, 1e-6);
  EXPECT_NEAR(fit.correlation, 1, 1e-9);
  EXPECT_NEAR(fit.rms_mm, 0, 1e-6);
  for (double& height : profile.height_mm) height = -height;
  EXPECT_LT(fit_profile(relief, profile, {5, 20}, {55, 20}).scale, 0) << "inside out";
  profile.along_mm[3] = profile.along_mm[2];
  EXPECT_THROW(fit_profile(relief, profile, {5, 20}, {55, 20}), InvalidInput);
}

}  // namespace
}  // namespace papilla
