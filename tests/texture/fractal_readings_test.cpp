// SPDX-License-Identifier: MIT
#include "papilla/texture/fractal_readings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/texture/box_dimension.hpp"
#include "papilla/texture/resample.hpp"
#include "papilla/texture/stein_surface.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

std::vector<FractalReadings> quarters(const GreyImage& image) {
  std::vector<FractalReadings> pieces;
  const int w = image.width / 2, h = image.height / 2;
  for (const int top : {0, h})
    for (const int left : {0, w}) pieces.push_back(read_fractal_dimensions(crop(image, left, top, w, h)));
  return pieces;
}

TEST(FractalReadings, AreThoseOfTheMethods) {
  const GreyImage image = test::noise_image(80, 70, 1, 8);
  const FractalReadings readings = read_fractal_dimensions(image);
  EXPECT_EQ(readings.box->dimension, box_dimension(image).dimension);
  EXPECT_EQ(readings.best->reason, best_dimension(image).reason);
  EXPECT_EQ(readings.fshot->sta, fshot_dimension(image).sta);
}

TEST(FractalReadings, SmallPicturesHaveNone) {
  const FractalReadings narrow = read_fractal_dimensions(test::noise_image(500, 31, 2));
  EXPECT_FALSE(narrow.box || narrow.fshot || narrow.best || narrow.probability);
  const FractalReadings small = read_fractal_dimensions(test::noise_image(65, 65, 2));
  EXPECT_TRUE(small.best.has_value());
  EXPECT_FALSE(small.probability.has_value());
}

TEST(FractalReadings, MeanOverPiecesFindsTheDimensionOfTheWhole) {
  for (const double hurst : {0.3, 0.7}) {
    const FractalReadings mean = mean_readings(quarters(to_grey_image(brownian_surface_exact({512, hurst, 3}))));
    EXPECT_NEAR(mean.best->estimate->dimension, 3 - hurst, 0.01);
    EXPECT_LE(mean.best->estimate->low, 3 - hurst);
    EXPECT_GE(mean.best->estimate->high, 3 - hurst);
    EXPECT_DOUBLE_EQ(mean.best->estimate->hurst, 3 - mean.best->estimate->dimension);
  }
}

TEST(FractalReadings, OnePieceIsItself) {
  const FractalReadings one = read_fractal_dimensions(test::noise_image(70, 70, 4));
  const FractalReadings mean = mean_readings(std::vector{one});
  EXPECT_EQ(mean.box->low, one.box->low);
  EXPECT_EQ(mean.fshot->str, one.fshot->str);
  EXPECT_EQ(mean.best->reason, one.best->reason);
}

TEST(FractalReadings, HalfOfThePiecesDecideOnThePowerLaw) {
  const FractalReadings rough = read_fractal_dimensions(to_grey_image(brownian_surface_exact({128, 0.5, 6})));
  const FractalReadings none = read_fractal_dimensions(test::noise_image(128, 128, 4));
  ASSERT_TRUE(rough.best->power_law());
  ASSERT_FALSE(none.best->power_law());
  const BestDimension half = *mean_readings(std::vector{rough, none, none, rough}).best;
  ASSERT_TRUE(half.power_law());
  EXPECT_DOUBLE_EQ(half.estimate->dimension, rough.best->estimate->dimension);
  EXPECT_EQ(half.least_scale_px, rough.best->least_scale_px);
  const BestDimension few = *mean_readings(std::vector{rough, none, none}).best;
  EXPECT_FALSE(few.power_law());
  EXPECT_NE(few.reason.find("2 of 3 pieces"), std::string::npos) << few.reason;
  EXPECT_NE(few.reason.find(none.best->reason), std::string::npos) << few.reason;
}

TEST(FractalReadings, IntervalIsThatOfTheMean) {
  // Student's 97.5 % quantile for one degree of freedom is 12.706; deviation of {2.49, 2.51} over √2 is 0.01.
  FractalReadings a, b;
  a.box = FractalEstimate{2.49, 0.51, 2.4, 2.6, {{8, 100}, {16, 25}}};
  b.box = FractalEstimate{2.51, 0.49, 2.4, 2.6, {{8, 400}}};
  const FractalEstimate mean = *mean_readings(std::vector{a, b}).box;
  EXPECT_NEAR(mean.dimension, 2.5, 1e-12);
  EXPECT_NEAR(mean.high - mean.low, 2 * 0.12706, 1e-4);
  ASSERT_EQ(mean.curve.size(), 1U);  // Only one scale is common.
  EXPECT_NEAR(mean.curve[0].measure, 200, 1e-9);
}

TEST(FractalReadings, PiecesOfAnisotropicSurfacesKeepTheirDirection) {
  const GreyImage image = test::make_image(256, 256, [](int x, int y) { return std::sin(0.9 * x) + 0.01 * y; });
  const FshotSignature whole = fshot_dimension(image);
  const FshotSignature mean = *mean_readings(quarters(image)).fshot;
  EXPECT_NEAR(std::sin((mean.angle_deg - whole.angle_deg) * std::numbers::pi / 180), 0, 0.1);  // 0 and 180 are one.
  EXPECT_NEAR(mean.str, whole.str, 0.05);
}

TEST(FractalReadings, EmptyPicturesAreRefused) { EXPECT_THROW(read_fractal_dimensions({}), InvalidInput); }

}  // namespace
}  // namespace papilla
