// SPDX-License-Identifier: MIT
// Reliefs and seeds that nothing was tuned to, through the model of photographs and back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "papilla/core/units.hpp"
#include "papilla/texture/height_from_image.hpp"
#include "papilla/texture/photograph_model.hpp"
#include "papilla/texture/relief_error.hpp"
#include "papilla/texture/stein_surface.hpp"
#include "papilla/texture/test_relief.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

constexpr std::uint64_t k_held_out = 7100;

double correlation(const HeightMap& found, const HeightMap& truth) {
  std::vector<double> px(found.mm.begin(), found.mm.end());
  return relief_error(px, truth).correlation;
}

/// Mean over all reliefs of what is measured on one photograph of each.
template <class Measure>
double mean_over_reliefs(PhotographCondition condition, const Measure& measure) {
  double sum = 0;
  const auto names = test_relief_names();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::uint64_t seed = k_held_out + 10 * i + static_cast<std::uint64_t>(condition);
    const HeightMap relief = test_relief(names[i], {.width = 240, .height = 192, .seed = seed});
    const PhotographOptions options = photograph_options(condition, seed);
    sum += measure(photograph(relief, options).picture, relief, options.light);
  }
  return sum / static_cast<double>(names.size());
}

class HeightOfPhotographs : public testing::TestWithParam<std::pair<PhotographCondition, double>> {};

TEST_P(HeightOfPhotographs, CorrelatesWithTheReliefUnderAGivenLight) {
  const auto [condition, least] = GetParam();
  const double mean = mean_over_reliefs(condition, [](const GreyImage& picture, const HeightMap& truth, Vec3 light) {
    const HeightResult result = height_from_image(picture, {.light = light});
    EXPECT_EQ(result.method, HeightMethod::wiener);
    EXPECT_FALSE(result.ambiguous);
    EXPECT_EQ(result.decoded, CurveSource::srgb);
    return correlation(result.map, truth);
  });
  EXPECT_GE(mean, least);
}

TEST_P(HeightOfPhotographs, WithoutALightCorrelatesUpToTheSideThatIsSaidToBeOpen) {
  double axis = 0;
  const double mean =
      mean_over_reliefs(GetParam().first, [&](const GreyImage& picture, const HeightMap& truth, Vec3 light) {
        const HeightResult result = height_from_image(picture, {.method = HeightMethod::wiener});
        EXPECT_TRUE(result.ambiguous);
        axis += std::abs(std::remainder(std::atan2(result.light.y, result.light.x) - std::atan2(light.y, light.x),
                                        std::numbers::pi)) *
                k_degrees_per_radian / 16;
        return std::abs(correlation(result.map, truth));
      });
  EXPECT_GE(mean, 0.6);
  EXPECT_LE(axis,
            16);  // Ribs, ovals and sine alone, whose own directions look like a light's, make 6 degrees of the mean.
}

// The mean of 16 pictures has a standard error of 0.03; wiener.md has those of more.
INSTANTIATE_TEST_SUITE_P(Conditions, HeightOfPhotographs,
                         testing::Values(std::pair{PhotographCondition::clean, 0.8},
                                         std::pair{PhotographCondition::spotted, 0.5},
                                         std::pair{PhotographCondition::glossy, 0.7}));

TEST(HeightOfAPhotograph, AHeightPictureIsReadAsHeights) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
    EXPECT_EQ(height_from_image(to_grey_image(brownian_surface_exact({129, 0.6, seed}), 8)).method,
              HeightMethod::intensity)
        << seed;
}

}  // namespace
}  // namespace papilla
