// SPDX-License-Identifier: MIT
#include "outstanding_wave.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "papilla/texture/spectral_surface.hpp"
#include "texture/fixtures.hpp"
#include "texture/wallpaper_patterns.hpp"

namespace papilla::texture_detail {
namespace {

GreyImage normal_noise(int width, int height, unsigned seed, double wave) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> noise;
  return test::make_image(width, height, [&](int x, int y) {
    return noise(engine) + wave * std::cos(2 * std::numbers::pi * (9.0 * x / width + 13.0 * y / height));
  });
}

/// Uniform on [0, 1] if the noise is what the formula takes it for.
TEST(OutstandingWave, ChanceOfNoiseIsUniform) {
  constexpr int k_pictures = 200;
  int below_tenth = 0, below_half = 0;
  for (unsigned seed = 1; seed <= k_pictures; ++seed) {
    const double p = chance_of_highest_wave(normal_noise(96, 80, seed, 0));
    below_tenth += p < 0.1;
    below_half += p < 0.5;
  }
  EXPECT_NEAR(below_tenth, 0.1 * k_pictures, 20);
  EXPECT_NEAR(below_half, 0.5 * k_pictures, 35);
}

TEST(OutstandingWave, SteepSpectraAreNoWaves) {
  for (const double hurst : {0.1, 0.25, 0.4})
    for (unsigned seed = 1; seed <= 10; ++seed) {
      const HeightGrid surface = spectral_surface({.size = 129, .hurst = hurst, .seed = seed});
      const GreyImage image = test::make_image(128, 128, [&](int x, int y) { return surface.at(x, y); });
      EXPECT_GT(chance_of_highest_wave(image), 1e-3) << hurst << ", " << seed;
    }
}

TEST(OutstandingWave, AWaveInNoiseStandsOut) {
  // Its power is a²/4 · 4/9 of the pixels' (Hann), against 1: 0.35² · 7680 / 9 = 104.
  EXPECT_LT(chance_of_highest_wave(normal_noise(96, 80, 1, 0.35)), 1e-9);
}

TEST(OutstandingWave, BadlyBentLatticesStandOut) {
  for (int group = 0; group < 17; ++group)
    EXPECT_LT(
        chance_of_highest_wave(
            test::photographed_pattern(static_cast<WallpaperGroup>(group), 77, test::k_badly_bent_photo, 192).image),
        1e-6)
        << group;
}

TEST(OutstandingWave, FlatAndTinyPicturesHaveNone) {
  EXPECT_EQ(chance_of_highest_wave(test::make_image(64, 64, [](int, int) { return 0.5; })), 1);
  EXPECT_EQ(chance_of_highest_wave(normal_noise(4, 4, 1, 0)), 1);
}

}  // namespace
}  // namespace papilla::texture_detail
