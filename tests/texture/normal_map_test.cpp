// SPDX-License-Identifier: MIT
#include "papilla/texture/normal_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "papilla/core/error.hpp"
#include "papilla/core/vec.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

Vec3 decoded(const ColorImage& image, int x, int y) {
  const std::size_t i =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
  return {image.pixels[i] / 127.5 - 1, image.pixels[i + 1] / 127.5 - 1, image.pixels[i + 2] / 127.5 - 1};
}

TEST(NormalMap, FlatIsTheConventionalBlue) {
  const ColorImage image = normal_map(test::make_relief(2, 2, 0.1, [](int, int) { return 3.0; }));
  EXPECT_EQ(image.pixels, (Values<unsigned char>{128, 128, 255, 128, 128, 255, 128, 128, 255, 128, 128, 255}));
}

TEST(NormalMap, SlopesLeanAwayFromTheRise) {
  // Rising to the right with slope 1: the normal leans left, (−1, 0, 1)/√2.
  HeightMap right = test::make_relief(8, 8, 0.25, [](int x, int) { return 0.25 * x; });
  right.periodic = false;
  const Vec3 left_leaning = decoded(normal_map(right), 4, 4);
  EXPECT_NEAR(left_leaning.x, -std::numbers::sqrt2 / 2, 0.005);
  EXPECT_NEAR(left_leaning.y, 0, 0.005);
  EXPECT_NEAR(left_leaning.z, std::numbers::sqrt2 / 2, 0.005);
  // Rising down the rows: the normal leans up the picture, which is +Y.
  HeightMap down = test::make_relief(8, 8, 0.25, [](int, int y) { return 0.25 * y; });
  down.periodic = false;
  const Vec3 up_leaning = decoded(normal_map(down), 4, 4);
  EXPECT_NEAR(up_leaning.y, std::numbers::sqrt2 / 2, 0.005);
  EXPECT_NEAR(up_leaning.x, 0, 0.005);
}

TEST(NormalMap, SineIsSeamlessAndPhysical) {
  constexpr int n = 64;
  constexpr double pitch = 0.05, amplitude = 0.1, wave = 2 * std::numbers::pi / (n * pitch);
  const ColorImage image =
      normal_map(test::make_relief(n, 4, pitch, [&](int x, int) { return amplitude * std::sin(wave * pitch * x); }));
  for (int x = 0; x < n; ++x) {
    const double slope = amplitude * wave * std::cos(wave * pitch * x);
    const Vec3 expected = normalized(Vec3{-slope, 0, 1});
    EXPECT_NEAR(decoded(image, x, 2).x, expected.x, 0.006) << x;
    EXPECT_NEAR(decoded(image, x, 2).z, expected.z, 0.006) << x;
  }
}

TEST(NormalMap, AnisotropicPitchScalesEachAxis) {
  HeightMap relief = test::make_relief(8, 8, 1, [](int x, int y) { return 0.5 * x + 0.5 * y; });
  relief.periodic = false;
  relief.pitch_mm_y = 2;
  const Vec3 normal = decoded(normal_map(relief), 3, 3), expected = normalized(Vec3{-0.5, 0.25, 1});
  EXPECT_NEAR(normal.x, expected.x, 0.005);
  EXPECT_NEAR(normal.y, expected.y, 0.005);
}

TEST(NormalMap, RefusesReliefsWithoutPitch) {
  EXPECT_THROW(normal_map(test::make_relief(4, 4, 0, [](int, int) { return 0.0; })), InvalidInput);
  EXPECT_THROW(normal_map(HeightMap{}), InvalidInput);
}

}  // namespace
}  // namespace papilla
