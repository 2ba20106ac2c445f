// SPDX-License-Identifier: MIT
#include "papilla/texture/probability_dimension.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "papilla/core/error.hpp"
#include "papilla/texture/stein_surface.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

/// Definition 6.5 pixel by pixel.
std::vector<std::int64_t> direct_counts(const GreyImage& image, int side) {
  const auto [low, high] = std::minmax_element(image.pixels.begin(), image.pixels.end());
  std::vector<int> grey;
  for (const float value : image.pixels)
    grey.push_back(static_cast<int>(std::lround(255 * (static_cast<double>(value) - static_cast<double>(*low)) /
                                                (static_cast<double>(*high) - static_cast<double>(*low)))));
  std::vector<std::int64_t> counts(static_cast<std::size_t>(side * side + 1), 0);
  const int r = (side - 1) / 2;
  for (int y = r; y < image.height - r; ++y)
    for (int x = r; x < image.width - r; ++x) {
      int points = 0;
      for (int j = -r; j <= r; ++j)
        for (int i = -r; i <= r; ++i)
          points += std::abs(grey[image.index(x + i, y + j)] - grey[image.index(x, y)]) <= r;
      ++counts[static_cast<std::size_t>(points)];
    }
  return counts;
}

TEST(ProbabilityDimension, CountsEqualTheDirectOnes) {
  const GreyImage pictures[] = {test::noise_image(66, 70, 1, 8),  // Narrower than a strip.
                                to_grey_image(brownian_surface_exact({130, 0.6, 2}), 8)};
  for (const GreyImage& image : pictures)
    for (const CubeHistogram& histogram : cube_histograms(image))
      EXPECT_EQ(histogram.counts, direct_counts(image, histogram.side)) << "side " << histogram.side;
}

TEST(ProbabilityDimension, SmallSidesCountToo) {
  const GreyImage image = to_grey_image(brownian_surface_exact({100, 0.3, 4}), 8);
  const std::vector<CubeHistogram> histograms = cube_histograms(image, {3, 7});
  ASSERT_EQ(histograms.size(), 3U);
  for (const CubeHistogram& histogram : histograms) EXPECT_EQ(histogram.counts, direct_counts(image, histogram.side));
}

TEST(ProbabilityDimension, FlatPictureIsAPlane) {
  EXPECT_NEAR(probability_dimension(test::make_image(80, 80, [](int, int) { return 1.0; })).dimension, 2, 1e-9);
}

TEST(ProbabilityDimension, RefusesBadArguments) {
  EXPECT_THROW(probability_dimension(test::noise_image(65, 80, 1)), InvalidInput);
  const GreyImage image = test::noise_image(80, 80, 1);
  EXPECT_THROW(probability_dimension(image, {12, 33}), InvalidInput);
  EXPECT_THROW(probability_dimension(image, {11, 35}), InvalidInput);
  EXPECT_THROW(probability_dimension(image, {11, 13}), InvalidInput);
}

}  // namespace
}  // namespace papilla
