// SPDX-License-Identifier: MIT
#include "papilla/texture/analysis_pictures.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "papilla/core/error.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

const unsigned char* pixel(const ColorImage& image, int x, int y) {
  return image.pixels.data() +
         3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
}

TEST(AnalysisPictures, StripShowsTheSynthesisAndAGreyDifference) {
  const GreyImage cell = test::noise_image(16, 16, 2, 8);
  const SymmetryAnalysis analysis = analyze_symmetry(test::make_image(
      96, 64, [&](int x, int y) { return static_cast<double>(cell.at(x % 16, y % 16)); }, 8));
  ASSERT_TRUE(analysis.lattice.found) << analysis.lattice.reason;
  const ColorImage strip = symmetry_strip(analysis);
  ASSERT_EQ(strip.width, 5 * 96 + 4 * 4);
  ASSERT_EQ(strip.height, 64);
  ASSERT_EQ(strip.pixels.size(), 3U * 496 * 64);
  const auto [low, high] = std::minmax_element(cell.pixels.begin(), cell.pixels.end());
  int coloured = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 96; ++x) {
      const double grey = (static_cast<double>(cell.at(x % 16, y % 16)) - static_cast<double>(*low)) /
                          (static_cast<double>(*high) - static_cast<double>(*low));
      ASSERT_NEAR(*pixel(strip, 300 + x, y), 255 * grey, 12);
      ASSERT_NEAR(*pixel(strip, 400 + x, y), 127.5, 8);  // The vectors are off by hundredths of a pixel.
      const unsigned char* original = pixel(strip, x, y);
      coloured += original[0] != original[2];
    }
  EXPECT_GT(coloured, 100);  // The lattice lines.
}

TEST(AnalysisPictures, WithoutLatticeTheLastPanelsAreGrey) {
  const ColorImage strip = symmetry_strip(analyze_symmetry(test::noise_image(40, 40, 1)));
  for (int x = 88; x < strip.width; ++x) EXPECT_EQ(*pixel(strip, x, 20), 128);
}

TEST(AnalysisPictures, GreyBecomesColour) {
  const ColorImage image = to_color_image(test::make_image(3, 1, [](int x, int) { return x - 0.5; }));
  EXPECT_EQ(image.pixels, (Values<unsigned char>{0, 0, 0, 128, 128, 128, 255, 255, 255}));
  EXPECT_THROW(to_color_image(GreyImage{}), InvalidInput);
}

}  // namespace
}  // namespace papilla
