// SPDX-License-Identifier: MIT
#include "papilla/texture/part_roughness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "papilla/core/error.hpp"
#include "papilla/texture/spectral_surface.hpp"
#include "shaped_noise.hpp"

namespace papilla {
namespace {

constexpr double k_pitch_mm = 0.05;
constexpr int k_size = 256;  // 12.8 mm.

double wave_mm(int x, int y) { return 0.02 * std::sin(2 * std::numbers::pi * (2 * x + 3 * y) / k_size); }

/// A wave of 3.6 mm under a self-affine surface.
HeightMap wavy_and_rough(double hurst, double rms_mm) {
  const HeightGrid surface = spectral_surface({.size = k_size, .hurst = hurst, .seed = 11});
  HeightMap map{k_size, k_size, {}, k_pitch_mm, k_pitch_mm, true};
  for (int y = 0; y < k_size; ++y)
    for (int x = 0; x < k_size; ++x) map.mm.push_back(static_cast<float>(rms_mm * surface.at(x, y) + wave_mm(x, y)));
  return map;
}

TEST(PartRoughness, TakesTheShortWavesOutAndLeavesTheRelief) {
  const HeightMap map = wavy_and_rough(0.4, 0.01);
  const PartedRelief parted = part_roughness(map);
  ASSERT_TRUE(parted.roughness) << parted.reason;
  // The surface's own waves below 1 mm, 20 pixels.
  std::vector<double> rough(map.mm.begin(), map.mm.end());
  texture_detail::filter(rough, k_size, k_size, true,
                         [](double x, double y) { return std::hypot(x, y) * 20 < 1 ? 0 : 1; });
  double squares = 0, worst = 0;
  for (std::size_t i = 0; i < rough.size(); ++i) {
    squares += rough[i] * rough[i];
    worst =
        std::max(worst, std::abs(static_cast<double>(map.mm[i]) - rough[i] - static_cast<double>(parted.relief.mm[i])));
  }
  EXPECT_NEAR(parted.roughness->rms_mm, std::sqrt(squares / static_cast<double>(rough.size())), 1e-6);
  EXPECT_LT(worst, 1e-6);
  EXPECT_NEAR(parted.roughness->hurst, 0.4, 0.15);
  EXPECT_DOUBLE_EQ(parted.roughness->shortest_mm, 0.1);
  EXPECT_DOUBLE_EQ(parted.roughness->longest_mm, 1);
  EXPECT_LT(parted.roughness->anisotropy, 1.2);
}

TEST(PartRoughness, FindsTheDirectionOfTheWaves) {
  // Waves three times as long along 30 degrees as across.
  const double angle = std::numbers::pi / 6, hurst = 0.5, stretch = std::sqrt(3.0);
  const std::vector<double> field = texture_detail::shaped_noise(240, 180, 5, [&](double x, double y) {
    const double along = stretch * (std::cos(angle) * x + std::sin(angle) * y),
                 across = (std::cos(angle) * y - std::sin(angle) * x) / stretch;
    const double f = std::hypot(along, across);
    return f > 0 ? std::pow(f, -hurst - 1) : 0;
  });
  HeightMap map{240, 180, {}, k_pitch_mm, k_pitch_mm, true};
  for (const double height : field) map.mm.push_back(static_cast<float>(0.01 * height));
  const PartedRelief parted = part_roughness(map);
  ASSERT_TRUE(parted.roughness) << parted.reason;
  EXPECT_NEAR(parted.roughness->hurst, hurst, 0.15);
  EXPECT_NEAR(parted.roughness->anisotropy, 3, 0.7);
  EXPECT_NEAR(parted.roughness->direction_rad, angle, 0.1);
}

/// Rows twice as far apart as columns, and half as high as wide.
TEST(PartRoughness, KnowsThePitchesOfBothAxes) {
  const HeightGrid surface = spectral_surface({.size = k_size, .hurst = 0.4, .seed = 11});
  HeightMap map{k_size, 64, {}, k_pitch_mm, 2 * k_pitch_mm, true};
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < k_size; ++x) map.mm.push_back(static_cast<float>(0.01 * surface.at(x, 2 * y)));
  const PartedRelief parted = part_roughness(map);
  ASSERT_TRUE(parted.roughness) << parted.reason;
  EXPECT_DOUBLE_EQ(parted.roughness->shortest_mm, 4 * k_pitch_mm);
  std::vector<double> rough(map.mm.begin(), map.mm.end());
  texture_detail::filter(rough, k_size, 64, true, [](double x, double y) {
    return std::hypot(x / k_pitch_mm, y / (2 * k_pitch_mm)) < 1 ? 0 : 1;  // Waves longer than 1 mm.
  });
  for (std::size_t i = 0; i < rough.size(); ++i)
    ASSERT_NEAR(static_cast<double>(map.mm[i]) - rough[i], static_cast<double>(parted.relief.mm[i]), 1e-6);
  const PartedRelief whole = part_roughness(map, 20);
  ASSERT_TRUE(whole.roughness) << whole.reason;
  EXPECT_DOUBLE_EQ(whole.roughness->longest_mm, 64 * 2 * k_pitch_mm);
}

TEST(PartRoughness, LeavesCoarseReliefsAlone) {
  HeightMap coarse = wavy_and_rough(0.4, 0.01);
  coarse.pitch_mm_x = coarse.pitch_mm_y = 0.3;
  const PartedRelief parted = part_roughness(coarse);
  EXPECT_FALSE(parted.roughness);
  EXPECT_EQ(parted.relief.mm, coarse.mm);
  EXPECT_NE(parted.reason.find("octaves"), std::string::npos);
}

TEST(PartRoughness, RefusesWhatHasNoScale) {
  HeightMap map = wavy_and_rough(0.4, 0.01);
  EXPECT_THROW(part_roughness(map, 0), InvalidInput);
  map.pitch_mm_x = 0;
  EXPECT_THROW(part_roughness(map), InvalidInput);
}

}  // namespace
}  // namespace papilla
