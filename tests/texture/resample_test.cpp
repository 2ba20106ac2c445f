// SPDX-License-Identifier: MIT
#include "papilla/texture/resample.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "papilla/core/error.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

/// Two waves over a tile of 8 × 6 mm, sampled at pixel centres.
HeightMap waves(int width, int height) {
  HeightMap map{width, height, {}, 8.0 / width, 6.0 / height, true};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double u = 2 * std::numbers::pi * (x + 0.5) / width, v = 2 * std::numbers::pi * (y + 0.5) / height;
      map.mm.push_back(static_cast<float>(1 + 0.3 * std::sin(3 * u + 2 * v + 0.4) + 0.2 * std::cos(u - 4 * v)));
    }
  return map;
}

TEST(Resample, BandLimitedReliefsAreKeptExactly) {
  const HeightMap source = waves(40, 31);
  for (const auto& [w, h] : {std::pair{80, 62}, std::pair{17, 23}, std::pair{64, 12}, std::pair{40, 50}}) {
    const HeightMap result = resample(source, w, h), expected = waves(w, h);
    ASSERT_EQ(result.mm.size(), expected.mm.size());
    EXPECT_NEAR(result.pitch_mm_x, expected.pitch_mm_x, 1e-12);
    EXPECT_NEAR(result.pitch_mm_y, expected.pitch_mm_y, 1e-12);
    EXPECT_TRUE(result.periodic);
    for (std::size_t i = 0; i < expected.mm.size(); ++i) ASSERT_NEAR(result.mm[i], expected.mm[i], 2e-6);
  }
}

TEST(Resample, WavesBeyondTheNewNyquistFrequencyVanish) {
  const HeightMap fine =
      test::make_relief(64, 64, 1, [](int x, int) { return std::sin(2 * std::numbers::pi * 20 * x / 64.0); });
  for (const float height : resample(fine, 32, 64).mm) EXPECT_NEAR(height, 0, 1e-6);
}

TEST(Resample, OpenReliefsAreContinuedByReflection) {
  HeightMap cosine{32, 1, {}, 1, 1, false};
  for (int x = 0; x < 32; ++x) cosine.mm.push_back(static_cast<float>(std::cos(std::numbers::pi * (x + 0.5) / 32)));
  const HeightMap half = resample(cosine, 16, 1);
  EXPECT_FALSE(half.periodic);
  for (int x = 0; x < 16; ++x) EXPECT_NEAR(half.at(x, 0), std::cos(std::numbers::pi * (x + 0.5) / 16), 1e-6);
}

TEST(Resample, TheMiddlePartLiesInTheMiddleOfBothSides) {
  const GreyImage image = test::make_image(30, 20, [](int x, int y) { return 0.01 * x + 0.0001 * y; });
  const GreyImage part = middle_part(image, 8);
  ASSERT_EQ(part.width, 8);
  ASSERT_EQ(part.height, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) EXPECT_EQ(part.at(x, y), image.at(11 + x, 6 + y)) << x << ' ' << y;
  EXPECT_EQ(middle_part(image, 25).height, 20);
}

TEST(Resample, SameSizeIsTheSameAndBadSizesAreRefused) {
  const HeightMap source = waves(10, 12);
  EXPECT_EQ(resample(source, 10, 12).mm, source.mm);
  EXPECT_THROW(resample(source, 0, 4), InvalidInput);
  EXPECT_THROW(resample(source, 4, 20000), InvalidInput);
  EXPECT_THROW(resample(HeightMap{}, 4, 4), InvalidInput);
}

}  // namespace
}  // namespace papilla
