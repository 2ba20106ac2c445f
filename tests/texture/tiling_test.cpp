// SPDX-License-Identifier: MIT
#include "papilla/texture/tiling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "papilla/core/error.hpp"
#include "papilla/texture/grain.hpp"
#include "papilla/texture/stein_surface.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

TEST(Tiling, AllGrainsTile) {
  for (const std::string_view name : grain_names())
    EXPECT_TRUE(measure_tiling(synthesize_grain(grain_kind(name), {128}).picture).tiles) << name;
}

TEST(Tiling, FractionalPeriodsDoNot) {
  const auto wave = [](double periods_x, double periods_y) {
    return measure_tiling(test::make_image(100, 80, [=](int x, int y) {
      return 0.5 + 0.2 * std::sin(2 * std::numbers::pi * periods_x * x / 100) +
             0.2 * std::cos(2 * std::numbers::pi * periods_y * y / 80);
    }));
  };
  EXPECT_TRUE(wave(4, 3).tiles);
  EXPECT_FALSE(wave(4.25, 3).tiles);
  EXPECT_FALSE(wave(4, 3.4).tiles);
}

TEST(Tiling, BrownianSurfacesDoNot) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    EXPECT_FALSE(measure_tiling(to_grey_image(brownian_surface_exact({65, 0.6, seed}))).tiles);
}

TEST(Tiling, FlatAndSinglePixelsTile) {
  EXPECT_TRUE(measure_tiling(test::noise_image(1, 1, 1)).tiles);
  EXPECT_TRUE(measure_tiling(test::make_image(8, 8, [](int, int) { return 0.5; })).tiles);
  EXPECT_THROW(measure_tiling(GreyImage{}), InvalidInput);
}

}  // namespace
}  // namespace papilla
