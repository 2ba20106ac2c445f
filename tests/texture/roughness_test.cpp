// SPDX-License-Identifier: MIT
#include "papilla/texture/roughness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "papilla/core/error.hpp"
#include "papilla/texture/stein_surface.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

TEST(Roughness, RmsOfASine) {
  const HeightMap sine =
      test::make_relief(64, 16, 0.1, [](int x, int) { return 5 + 0.2 * std::sin(2 * std::numbers::pi * x / 16); });
  EXPECT_NEAR(rms_height_mm(sine), 0.2 / std::numbers::sqrt2, 1e-6);
  const Roughness roughness = measure_roughness(sine);
  EXPECT_DOUBLE_EQ(roughness.rms_mm, rms_height_mm(sine));
  EXPECT_FALSE(roughness.fractal.has_value());  // Below 32 rows.
  EXPECT_DOUBLE_EQ(roughness.shortest_wavelength_mm, 0.2);
  EXPECT_DOUBLE_EQ(roughness.longest_wavelength_mm, 1.6);
  HeightMap tall = sine;
  tall.pitch_mm_y = 0.5;
  EXPECT_DOUBLE_EQ(measure_roughness(tall).shortest_wavelength_mm, 1);
  EXPECT_DOUBLE_EQ(measure_roughness(tall).longest_wavelength_mm, 6.4);
}

TEST(Roughness, FractalDimensionOfAnExactSurface) {
  const HeightGrid surface = brownian_surface_exact({257, 0.4, 1});
  HeightMap relief{257, 257, {surface.heights.begin(), surface.heights.end()}, 0.05, 0.05, false};
  EXPECT_NEAR(measure_roughness(relief).fractal.value().dimension, 2.6, 0.02);
}

TEST(Roughness, RefusesBadReliefs) {
  EXPECT_THROW(rms_height_mm(HeightMap{}), InvalidInput);
  EXPECT_THROW(measure_roughness(test::make_relief(4, 4, 0, [](int, int) { return 0.0; })), InvalidInput);
}

}  // namespace
}  // namespace papilla
