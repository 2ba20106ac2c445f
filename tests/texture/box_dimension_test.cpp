// SPDX-License-Identifier: MIT
#include "papilla/texture/box_dimension.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

#include "papilla/core/error.hpp"
#include "papilla/texture/stein_surface.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

using Estimator = FractalEstimate (*)(const GreyImage&);
constexpr Estimator k_estimators[] = {box_dimension, information_dimension, correlation_dimension};

TEST(BoxDimension, PlanesHaveDimensionTwo) {
  const GreyImage flat = test::make_image(192, 192, [](int, int) { return 0.3; });
  for (const Estimator estimate : k_estimators) EXPECT_NEAR(estimate(flat).dimension, 2, 1e-9);
  // Sides that no box divides.
  for (const auto& [width, height] : {std::pair(197, 101), std::pair(101, 197)}) {
    const GreyImage oblong = test::make_image(width, height, [](int, int) { return 0.3; });
    EXPECT_NEAR(box_dimension(oblong).dimension, 2, 1e-9) << width;
  }
  // A ramp of one grey level a pixel: the diagonal plane through all boxes.
  const GreyImage ramp = test::make_image(
      256, 256, [](int x, int) { return x / 255.0; }, 8);
  EXPECT_NEAR(box_dimension(ramp).dimension, 2, 1e-9);
}

TEST(BoxDimension, CountsEqualASetOfBoxes) {
  const GreyImage image = test::noise_image(128, 128, 3, 8);
  for (const ScalePoint& point : box_dimension(image).curve) {
    const int s = static_cast<int>(point.scale);
    std::map<std::tuple<int, int, int>, int> boxes;
    const auto [low, high] = std::minmax_element(image.pixels.begin(), image.pixels.end());
    for (int y = 0; y < 128; ++y)
      for (int x = 0; x < 128; ++x) {
        const double g = 255 * (static_cast<double>(image.at(x, y)) - static_cast<double>(*low)) /
                         (static_cast<double>(*high) - static_cast<double>(*low));
        ++boxes[{x / s, y / s, static_cast<int>(std::lround(g)) / s}];
      }
    EXPECT_DOUBLE_EQ(point.measure, static_cast<double>(boxes.size())) << "side " << s;
  }
}

/// The readings on exact surfaces, as documented: they saturate with rising roughness.
TEST(BoxDimension, ReadingsOnExactSurfaces) {
  const double expected[3][3] = {{2.10, 2.29, 2.50}, {2.10, 2.34, 2.50}, {2.09, 2.34, 2.50}};
  const double dimensions[3] = {2.2, 2.5, 2.8};
  for (int d = 0; d < 3; ++d) {
    double mean[3] = {0, 0, 0};
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
      const GreyImage image = to_grey_image(brownian_surface_exact({257, 3 - dimensions[d], seed}), 8);
      for (int e = 0; e < 3; ++e) mean[e] += k_estimators[e](image).dimension / 4;
    }
    for (int e = 0; e < 3; ++e)
      EXPECT_NEAR(mean[e], expected[e][d], 0.05) << "estimator " << e << " D " << dimensions[d];
  }
}

TEST(BoxDimension, AnySizeFrom32OnGivesAFiniteInterval) {
  for (const auto& [w, h] : {std::pair{32, 32}, std::pair{33, 200}, std::pair{130, 185}})
    for (const Estimator estimate : k_estimators) {
      const FractalEstimate e = estimate(test::noise_image(w, h, 7));
      EXPECT_TRUE(std::isfinite(e.dimension) && std::isfinite(e.low) && std::isfinite(e.high));
      EXPECT_LE(e.low, e.dimension);
      EXPECT_GE(e.high, e.dimension);
      EXPECT_DOUBLE_EQ(e.hurst, 3 - e.dimension);
    }
  for (const Estimator estimate : k_estimators) EXPECT_THROW(estimate(test::noise_image(31, 64, 1)), InvalidInput);
  EXPECT_THROW(box_dimension(GreyImage{}), InvalidInput);
}

}  // namespace
}  // namespace papilla
