// SPDX-License-Identifier: MIT
#include "papilla/texture/best_dimension.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "papilla/core/error.hpp"
#include "papilla/texture/stein_surface.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

/// Root mean square error of D and share of intervals that hold the truth over 27 exact surfaces of 257².
struct Score {
  double rmse = 0, coverage = 0;
};

Score score(int bits) {
  Score result;
  int runs = 0;
  for (const double dimension : {2.1, 2.2, 2.3, 2.4, 2.5, 2.6, 2.7, 2.8, 2.9})
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const HeightGrid surface = brownian_surface_exact({257, 3 - dimension, seed});
      const FractalEstimate estimate = best_dimension(to_grey_image(surface, bits)).estimate;
      result.rmse += std::pow(estimate.dimension - dimension, 2);
      result.coverage += estimate.low <= dimension && dimension <= estimate.high;
      ++runs;
    }
  return {std::sqrt(result.rmse / runs), result.coverage / runs};
}

TEST(BestDimension, ReadsExactSurfaces) {
  const Score found = score(32);
  EXPECT_LT(found.rmse, 0.006);
  EXPECT_GT(found.coverage, 0.8);
}

TEST(BestDimension, QuantizationIsRemoved) { EXPECT_LT(score(8).rmse, 0.008); }

TEST(BestDimension, TiltAndScaleDoNotMatter) {
  const GreyImage image = to_grey_image(brownian_surface_exact({129, 0.4, 5}));
  GreyImage other = image;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      other.at(x, y) = 0.5F * image.at(x, y) + 0.01F * static_cast<float>(x - 2 * y);
  EXPECT_NEAR(best_dimension(image).estimate.dimension, best_dimension(other).estimate.dimension, 1e-3);
}

TEST(BestDimension, DirectionsAreToldApart) {
  // Rough along x, smooth along y: rows are random walks, which repeat down the columns with a slow wave.
  const GreyImage rows = test::make_image(
      64, 64, [](int x, int y) { return 0.5 + 0.1 * std::sin(x * x * 1.7) + 0.2 * std::sin(0.05 * y); });
  const auto hurst = best_dimension(rows).directional_hurst;
  EXPECT_LT(hurst[0], 0.3);
  EXPECT_GT(hurst[1], 1.5);  // A smooth curve: second differences grow with k².
}

TEST(BestDimension, FlatPictureIsAPlane) {
  const FractalEstimate flat = best_dimension(test::make_image(
                                                  40, 40, [](int, int) { return 0.25; }, 8))
                                   .estimate;
  EXPECT_EQ(flat.dimension, 2);
  EXPECT_EQ(flat.high - flat.low, 0);
}

TEST(BestDimension, RefusesBadPictures) {
  EXPECT_THROW(best_dimension(test::noise_image(31, 40, 1)), InvalidInput);
  GreyImage bad = test::noise_image(40, 40, 1);
  bad.at(3, 4) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(best_dimension(bad), InvalidInput);
  bad.pixels.pop_back();
  EXPECT_THROW(best_dimension(bad), InvalidInput);
}

}  // namespace
}  // namespace papilla
