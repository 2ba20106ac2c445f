// SPDX-License-Identifier: MIT
#include "papilla/texture/part_roughness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "papilla/core/error.hpp"
#include "papilla/texture/spectral_surface.hpp"

namespace papilla {
namespace {

constexpr double k_pitch_mm = 0.05;
constexpr int k_size = 256;  // 12.8 mm.

/// Waves of 6.4 and 4.27 mm under a self-affine surface of 0.1 to 1 mm.
HeightMap wavy_and_rough(double hurst, double rms_mm, double longest_px) {
  const HeightGrid surface =
      spectral_surface({.size = k_size, .hurst = hurst, .longest_wavelength_px = longest_px, .seed = 11});
  HeightMap map{k_size, k_size, {}, k_pitch_mm, k_pitch_mm, true};
  for (int y = 0; y < k_size; ++y)
    for (int x = 0; x < k_size; ++x)
      map.mm.push_back(static_cast<float>(rms_mm * surface.at(x, y) +
                                          0.02 * std::sin(2 * std::numbers::pi * (2 * x + 3 * y) / k_size)));
  return map;
}

TEST(PartRoughness, TakesTheShortWavesOutAndLeavesTheRelief) {
  const HeightMap map = wavy_and_rough(0.4, 0.01, 1 / k_pitch_mm);
  const PartedRelief parted = part_roughness(map);
  ASSERT_TRUE(parted.roughness) << parted.reason;
  EXPECT_NEAR(parted.roughness->rms_mm, 0.01, 5e-4);
  EXPECT_DOUBLE_EQ(parted.roughness->shortest_mm, 0.1);
  EXPECT_DOUBLE_EQ(parted.roughness->longest_mm, 1);
  EXPECT_LT(parted.roughness->anisotropy, 1.2);
  double worst = 0;
  for (int y = 0; y < k_size; ++y)
    for (int x = 0; x < k_size; ++x)
      worst = std::max(worst, std::abs(static_cast<double>(parted.relief.at(x, y)) -
                                       0.02 * std::sin(2 * std::numbers::pi * (2 * x + 3 * y) / k_size)));
  EXPECT_LT(worst, 3e-3);  // What the surface has beyond 1 mm: rounded wave numbers.
}

TEST(PartRoughness, FindsTheDirectionOfTheWaves) {
  // A surface drawn out by three along 30 degrees.
  const double angle = std::numbers::pi / 6;
  const HeightGrid surface = spectral_surface({.size = 512, .hurst = 0.5, .seed = 5});
  HeightMap map{200, 150, {}, k_pitch_mm, k_pitch_mm, false};
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const double along = (std::cos(angle) * x + std::sin(angle) * y) / 3,
                   across = -std::sin(angle) * x + std::cos(angle) * y;
      const auto wrapped = [](double v) { return static_cast<int>(std::floor(v)) & 511; };
      const double fx = along - std::floor(along), fy = across - std::floor(across);
      const auto z = [&](int i, int j) { return surface.at(wrapped(along + i), wrapped(across + j)); };
      map.mm.push_back(static_cast<float>(0.01 * ((1 - fx) * (1 - fy) * z(0, 0) + fx * (1 - fy) * z(1, 0) +
                                                  (1 - fx) * fy * z(0, 1) + fx * fy * z(1, 1))));
    }
  const PartedRelief parted = part_roughness(map);
  ASSERT_TRUE(parted.roughness) << parted.reason;
  EXPECT_GT(parted.roughness->anisotropy, 1.8);
  EXPECT_NEAR(parted.roughness->direction_rad, angle, 0.1);
}

TEST(PartRoughness, LeavesCoarseReliefsAlone) {
  HeightMap coarse = wavy_and_rough(0.4, 0.01, 20);
  coarse.pitch_mm_x = coarse.pitch_mm_y = 0.3;
  const PartedRelief parted = part_roughness(coarse);
  EXPECT_FALSE(parted.roughness);
  EXPECT_EQ(parted.relief.mm, coarse.mm);
  EXPECT_NE(parted.reason.find("octaves"), std::string::npos);
}

TEST(PartRoughness, RefusesWhatHasNoScale) {
  HeightMap map = wavy_and_rough(0.4, 0.01, 20);
  EXPECT_THROW(part_roughness(map, 0), InvalidInput);
  map.pitch_mm_x = 0;
  EXPECT_THROW(part_roughness(map), InvalidInput);
}

}  // namespace
}  // namespace papilla
