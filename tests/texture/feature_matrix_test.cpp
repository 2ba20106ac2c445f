// SPDX-License-Identifier: MIT
#include "papilla/texture/feature_matrix.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "papilla/core/error.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

/// The definition, pixel by pixel.
double direct(const GreyImage& image, int dx, int dy) {
  double sum = 0;
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      if (x + dx < 0 || x + dx >= image.width || y + dy < 0 || y + dy >= image.height) continue;
      const double d = static_cast<double>(image.at(x, y)) - static_cast<double>(image.at(x + dx, y + dy));
      sum += d * d;
      ++count;
    }
  return sum / count;
}

TEST(FeatureMatrix, EqualsTheDirectSumOfFloatingPointPictures) {
  const GreyImage image = test::noise_image(45, 32, 1);
  const FeatureMatrix matrix = feature_matrix(image);
  ASSERT_EQ(matrix.reach_x, 22);
  ASSERT_EQ(matrix.reach_y, 16);
  for (int dy = -16; dy <= 16; ++dy)
    for (int dx = -22; dx <= 22; ++dx) EXPECT_NEAR(matrix.at(dx, dy), direct(image, dx, dy), 1e-12);
}

TEST(FeatureMatrix, EightBitPicturesGiveTheExactIntegerSum) {
  const GreyImage image = test::noise_image(64, 51, 2, 8);
  const FeatureMatrix matrix = feature_matrix(image);
  for (int dy = 0; dy <= matrix.reach_y; ++dy)
    for (int dx = -matrix.reach_x; dx <= matrix.reach_x; ++dx) {
      std::int64_t sum = 0, count = 0;
      for (int y = 0; y + dy < 51; ++y)
        for (int x = std::max(0, -dx); x < std::min(64, 64 - dx); ++x) {
          const auto d = std::lround(255.0 * static_cast<double>(image.at(x, y))) -
                         std::lround(255.0 * static_cast<double>(image.at(x + dx, y + dy)));
          sum += d * d;
          ++count;
        }
      EXPECT_EQ(std::llround(matrix.at(dx, dy) * 255 * 255 * static_cast<double>(count)), sum);
      EXPECT_NEAR(matrix.at(dx, dy), static_cast<double>(sum) / static_cast<double>(count) / (255.0 * 255.0), 1e-15);
      EXPECT_EQ(matrix.at(dx, dy), matrix.at(-dx, -dy));
    }
}

TEST(FeatureMatrix, IsZeroAtThePeriodsOnly) {
  const FeatureMatrix matrix = feature_matrix(test::make_image(
      48, 48, [](int x, int y) { return ((x * 7 + y * 3) % 8) / 255.0; }, 8));
  for (int dy = -24; dy <= 24; ++dy)
    for (int dx = -24; dx <= 24; ++dx)
      EXPECT_EQ(matrix.at(dx, dy) == 0, (dx * 7 + dy * 3) % 8 == 0) << dx << ", " << dy;
}

TEST(FeatureMatrix, AbsoluteDistortionIsTheDirectSum) {
  for (const int bits : {8, 32}) {
    const GreyImage image = test::noise_image(23, 18, 4, bits);
    const FeatureMatrix matrix = absolute_feature_matrix(image);
    ASSERT_EQ(matrix.width(), 23);
    ASSERT_EQ(matrix.height(), 19);
    for (int dy = -matrix.reach_y; dy <= matrix.reach_y; ++dy)
      for (int dx = -matrix.reach_x; dx <= matrix.reach_x; ++dx) {
        double sum = 0;
        int count = 0;
        for (int y = std::max(0, -dy); y < std::min(18, 18 - dy); ++y)
          for (int x = std::max(0, -dx); x < std::min(23, 23 - dx); ++x, ++count)
            sum += std::abs(static_cast<double>(image.at(x, y)) - static_cast<double>(image.at(x + dx, y + dy)));
        EXPECT_NEAR(matrix.at(dx, dy), sum / count, 1e-7);
      }
  }
  EXPECT_THROW(absolute_feature_matrix(GreyImage{}), InvalidInput);
}

TEST(FeatureMatrix, TakesAnySize) {
  EXPECT_EQ(feature_matrix(test::noise_image(1, 1, 1)).distortion.size(), 1U);
  const FeatureMatrix line = feature_matrix(test::noise_image(1, 9, 1));
  EXPECT_EQ(line.width(), 1);
  EXPECT_EQ(line.height(), 9);
  EXPECT_THROW(feature_matrix(GreyImage{}), InvalidInput);
  GreyImage bad = test::noise_image(8, 8, 1);
  bad.at(0, 0) = std::numeric_limits<float>::infinity();
  EXPECT_THROW(feature_matrix(bad), InvalidInput);
}

}  // namespace
}  // namespace papilla
