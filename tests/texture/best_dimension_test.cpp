// SPDX-License-Identifier: MIT
#include "papilla/texture/best_dimension.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "papilla/core/error.hpp"
#include "papilla/texture/resample.hpp"
#include "papilla/texture/spectral_surface.hpp"
#include "texture/fixtures.hpp"
#include "texture/seen_surface.hpp"

namespace papilla {
namespace {

/// Root mean square error of D and share of intervals that hold the truth.
struct Score {
  double rmse = 0, coverage = 0;
};

/// Over D = 2.1, 2.3 … 2.9 and seeds that nothing was chosen by.
Score score(test::SeenSurface how, int seeds) {
  Score result;
  int runs = 0;
  for (const double dimension : {2.1, 2.3, 2.5, 2.7, 2.9})
    for (int seed = 0; seed < seeds; ++seed) {
      how.dimension = dimension;
      how.seed = static_cast<std::uint64_t>(9000 + 10 * seed + runs % 10);
      const BestDimension best = best_dimension(test::seen_surface(how));
      ++runs;
      if (!best.power_law()) {
        ADD_FAILURE() << "D " << dimension << " seed " << how.seed << ": " << best.reason;
        continue;
      }
      EXPECT_GE(best.estimate->low, 2);
      EXPECT_LE(best.estimate->high, 3);
      result.rmse += std::pow(best.estimate->dimension - dimension, 2);
      result.coverage += best.estimate->low <= dimension && dimension <= best.estimate->high;
    }
  return {std::sqrt(result.rmse / runs), result.coverage / runs};
}

TEST(BestDimension, ReadsExactSurfaces) {
  const Score found = score({.bits = 32}, 5);
  EXPECT_LT(found.rmse, 0.006);
  EXPECT_GE(found.coverage, 0.9);
}

TEST(BestDimension, QuantizationIsRemoved) { EXPECT_LT(score({}, 5).rmse, 0.008); }

TEST(BestDimension, SeesThroughPointSpreadAndNoise) {
  struct Condition {
    double spread_px, noise, limit;
  };
  for (const auto& [spread, noise, limit] :
       {Condition{0.5, 0, 0.06}, Condition{0.8, 0.01, 0.12}, Condition{1.2, 0.02, 0.2}}) {
    const Score found = score({.spread_px = spread, .noise = noise}, 2);
    EXPECT_LE(found.rmse, limit) << "point spread " << spread << " noise " << noise;
    EXPECT_GE(found.coverage, 0.9) << "point spread " << spread << " noise " << noise;
  }
}

TEST(BestDimension, SeesThroughALensBeforeThePixels) {
  const Score lens = score({.side = 257, .spread_px = 0.5, .finer = 2}, 2);
  EXPECT_LE(lens.rmse, 0.06);
  EXPECT_GE(lens.coverage, 0.9);
}

TEST(BestDimension, SeesThroughPixelsThatAverageTheirArea) {
  const Score area = score({.side = 160, .spread_px = 0.4, .noise = 0.005, .finer = 3, .pixel_area = true}, 2);
  EXPECT_LE(area.rmse, 0.1);
  EXPECT_GE(area.coverage, 0.9);
}

TEST(BestDimension, SaysWhatItSaw) {
  const BestDimension best = best_dimension(test::seen_surface({.dimension = 2.4, .spread_px = 0.9, .noise = 0.01}));
  ASSERT_TRUE(best.power_law());
  EXPECT_NEAR(best.psf_sigma_px, 0.9, 0.15);
  EXPECT_NEAR(best.noise_rms, 0.01, 0.001);
  EXPECT_GT(best.least_scale_px, 3);
  EXPECT_GT(best.most_scale_px, 100);
  EXPECT_NEAR(best.chi2_per_dof, 1, 1);
  EXPECT_NEAR(best.quantization_step, 1.0 / 255, 1e-9);
}

TEST(BestDimension, TiltAndScaleDoNotMatter) {
  const GreyImage image = to_grey_image(brownian_surface_exact({129, 0.4, 5}));
  GreyImage other = image;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      other.at(x, y) = 0.5F * image.at(x, y) + 0.01F * static_cast<float>(x - 2 * y);
  EXPECT_NEAR(best_dimension(image).estimate.value().dimension, best_dimension(other).estimate.value().dimension, 1e-3);
}

TEST(BestDimension, OblongPicturesAreRead) {
  const GreyImage square = to_grey_image(brownian_surface_exact({400, 0.6, 8}));
  const BestDimension best = best_dimension(crop(square, 10, 30, 390, 130));
  ASSERT_TRUE(best.power_law());
  EXPECT_LE(best.estimate->low, 2.4);
  EXPECT_GE(best.estimate->high, 2.4);
}

TEST(BestDimension, DirectionsAreToldApart) {
  const BestDimension best = best_dimension(
      to_grey_image(spectral_surface({.size = 256, .hurst = 0.4, .seed = 3, .hurst_across = 0.7, .angle_deg = 0})));
  ASSERT_TRUE(best.directional_hurst);
  EXPECT_LT((*best.directional_hurst)[0] + 0.15, (*best.directional_hurst)[1]);
}

TEST(BestDimension, AmplitudeMayDependOnDirection) {
  // A surface pressed along x: the same H, steeper along x.
  const HeightGrid surface = brownian_surface_exact({500, 0.5, 4});
  GreyImage pressed{250, 500, {}, 0, 32};
  for (int y = 0; y < 500; ++y)
    for (int x = 0; x < 250; ++x) pressed.pixels.push_back(static_cast<float>(surface.at(2 * x, y)));
  const BestDimension best = best_dimension(pressed);
  ASSERT_TRUE(best.power_law());
  EXPECT_NEAR(best.estimate->dimension, 2.5, 0.1);
}

/// No dimension, and that reason.
void expect_none(const GreyImage& image, const char* reason) {
  const BestDimension best = best_dimension(image);
  EXPECT_FALSE(best.power_law()) << best.estimate->dimension << ", expected: " << reason;
  EXPECT_EQ(best.reason.rfind(reason, 0), 0U) << best.reason;
  EXPECT_FALSE(best.directional_hurst);
  EXPECT_EQ(best.most_scale_px, 0);
}

TEST(BestDimension, FlatPicturesHaveNone) {
  expect_none(test::make_image(
                  40, 40, [](int, int) { return 0.25; }, 8),
              "flat");
}

TEST(BestDimension, SmoothPicturesHaveNone) {
  expect_none(test::seen_surface({.dimension = 2.5, .side = 200, .spread_px = 4, .bits = 32}), "smooth");
}

TEST(BestDimension, PeriodicPicturesHaveNone) {
  const GreyImage noise = test::noise_image(256, 256, 3);
  expect_none(test::make_image(
                  256, 200,
                  [&](int x, int y) {
                    const double wave = std::sin(2 * std::numbers::pi * (x / 9.3 + y / 40.0));
                    return 0.5 + 0.3 * wave + 0.05 * static_cast<double>(noise.at(x, y));
                  },
                  8),
              "periodic");
}

TEST(BestDimension, NoiseHasNone) { expect_none(test::noise_image(300, 200, 5, 8), "level"); }

TEST(BestDimension, TwoRegimesHaveNone) {
  // Rough within grains of 40 pixels, nearly level beyond: z minus its own wide mean.
  const HeightGrid surface = brownian_surface_exact({300, 0.8, 2});
  const std::vector<double> wide = test::blurred(surface.heights, 300, 5);
  GreyImage image{300, 300, {}, 0, 32};
  for (std::size_t i = 0; i < wide.size(); ++i)
    image.pixels.push_back(static_cast<float>(surface.heights[i] - wide[i]));
  expect_none(image, "no single power law");
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
