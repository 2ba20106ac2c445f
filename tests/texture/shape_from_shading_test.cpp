// SPDX-License-Identifier: MIT
#include "papilla/texture/shape_from_shading.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/texture/shading.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

constexpr int k_side = 96;
using Relief = std::function<double(double, double)>;

/// 8-bit Lambert picture of z(x, y) from its derivatives, independent of the product's renderer.
GreyImage lit(const Relief& z, Vec3 light) {
  const Vec3 s = normalized(light);
  return test::make_image(
      k_side, k_side,
      [&](int x, int y) {
        constexpr double h = 1e-3;
        const double p = (z(x + h, y) - z(x - h, y)) / (2 * h), q = (z(x, y + h) - z(x, y - h)) / (2 * h);
        return std::round(255 * std::max(0.0, (s.z - s.x * p - s.y * q) / std::sqrt(1 + p * p + q * q))) / 255;
      },
      8);
}

/// Mean |dz| over the range of z, after the best plane is taken from dz.
double depth_error(const std::vector<double>& found, const Relief& z) {
  const double middle = (k_side - 1) / 2.0;
  double sum = 0, sum_x = 0, sum_y = 0, square = 0, low = 1e300, high = -1e300;
  std::vector<double> difference;
  for (int y = 0; y < k_side; ++y)
    for (int x = 0; x < k_side; ++x) {
      const double truth = z(x, y), d = found[difference.size()] - truth;
      difference.push_back(d);
      sum += d;
      sum_x += d * (x - middle);
      sum_y += d * (y - middle);
      square += (x - middle) * (x - middle);
      low = std::min(low, truth);
      high = std::max(high, truth);
    }
  const auto count = static_cast<double>(difference.size());
  double error = 0;
  for (std::size_t i = 0; i < difference.size(); ++i) {
    const double x = static_cast<double>(i % k_side) - middle, y = static_cast<double>(i / k_side) - middle;
    error += std::abs(difference[i] - sum / count - sum_x / square * x - sum_y / square * y);
  }
  return error / count / (high - low);
}

double bump(double x, double y, double cx, double cy, double height, double width) {
  return height * std::exp(-((x - cx) * (x - cx) + (y - cy) * (y - cy)) / (2 * width * width));
}

/// The five reliefs of the literature's comparisons.
std::vector<Relief> reliefs() {
  return {[](double x, double y) {
            return std::sqrt(std::max(0.0, 30.0 * 30 - (x - 47.5) * (x - 47.5) - (y - 47.5) * (y - 47.5)));
          },
          [](double x, double y) {
            return bump(x, y, 27, 26, 10, 10) + bump(x, y, 68, 30, 8, 9) + bump(x, y, 45, 68, 11, 11);
          },
          [](double x, double y) {
            return 2 * std::sin(2 * std::numbers::pi * x / 24) * std::sin(2 * std::numbers::pi * y / 24);
          },
          [](double x, double y) { return bump(x, y, 47.5, 47.5, 19, 16); },
          [](double x, double y) {
            return 3 * std::sin(0.11 * x + 0.05 * y) + 2 * std::cos(0.07 * x - 0.12 * y) + std::sin(0.2 * y);
          }};
}

class ObliqueLight : public testing::TestWithParam<Vec3> {};

TEST_P(ObliqueLight, VariationalFindsKnownReliefs) {
  double variational = 0, tsai_shah = 0;
  for (const Relief& z : reliefs()) {
    ShadingOptions options;
    options.light = GetParam();
    const GreyImage image = lit(z, options.light);
    variational += depth_error(shape_from_shading_variational(image, options).height_px, z) / 5;
    tsai_shah += depth_error(shape_from_shading_tsai_shah(image, options).height_px, z) / 5;
  }
  EXPECT_LT(variational, 0.12);
  EXPECT_LT(tsai_shah, 0.25);
  EXPECT_LT(variational, tsai_shah);
  RecordProperty("variational", std::to_string(variational));
  RecordProperty("tsai_shah", std::to_string(tsai_shah));
}

INSTANTIATE_TEST_SUITE_P(Lights, ObliqueLight, testing::Values(Vec3{0.3, 0.3, 1}, Vec3{1, 0, 1}, Vec3{1, 1, 1}));

TEST(ShapeFromShading, WeaveLitAlongOneAxisIsExact) {
  const Relief weave = [](double x, double y) {
    return 2 * std::sin(2 * std::numbers::pi * x / 24) * std::sin(2 * std::numbers::pi * y / 24);
  };
  ShadingOptions options;
  options.light = {1, 0, 1};
  options.periodic = true;
  EXPECT_LT(depth_error(shape_from_shading_variational(lit(weave, options.light), options).height_px, weave), 0.03);
}

TEST(ShapeFromShading, PentlandIsExactForGentleWavesAlongTheLight) {
  const Relief wave = [](double x, double) { return 0.2 * std::sin(2 * std::numbers::pi * x / 24); };
  ShadingOptions options;
  options.light = {1, 0, 1};
  options.periodic = true;
  const ShadingResult result = shape_from_shading_pentland(lit(wave, options.light), options);
  EXPECT_LT(depth_error(result.height_px, wave), 0.02);
  ASSERT_EQ(result.trace.size(), 1U);
  EXPECT_LT(result.trace[0].error, 0.01);
}

/// Large pictures are solved from coarse to fine.
TEST(ShapeFromShading, PyramidFindsWhatOneLevelFinds) {
  const int side = 200;
  const auto z = [](int x, int y) { return 9 * std::exp(-((x - 100) * (x - 100) + (y - 90) * (y - 90)) / 900.0); };
  const HeightMap relief = test::make_relief(side, side, 1, z);
  const Vec3 light = normalized(Vec3{1, 1, 1});
  ShadingOptions options;
  options.light = light;
  const ShadingResult result = shape_from_shading_variational(render_lambert(relief, light), options);
  double mean = 0, error = 0;
  for (const float height : relief.mm) mean += static_cast<double>(height) / static_cast<double>(relief.mm.size());
  for (std::size_t i = 0; i < relief.mm.size(); ++i)
    error += std::abs(result.height_px[i] - static_cast<double>(relief.mm[i]) + mean) /
             static_cast<double>(relief.mm.size());
  EXPECT_LT(error / 9, 0.06);
}

TEST(ShapeFromShading, PeriodicResultsShiftWithThePicture) {
  const Relief weave = [](double x, double y) {
    return 2 * std::sin(2 * std::numbers::pi * x / 32) + std::cos(2 * std::numbers::pi * y / 48);
  };
  ShadingOptions options;
  options.periodic = true;
  const GreyImage image = lit(weave, options.light);
  GreyImage moved = image;
  for (int y = 0; y < k_side; ++y)
    for (int x = 0; x < k_side; ++x) moved.at((x + 41) % k_side, (y + 67) % k_side) = image.at(x, y);
  const ShadingResult a = shape_from_shading_variational(image, options),
                      b = shape_from_shading_variational(moved, options);
  for (int y = 0; y < k_side; ++y)
    for (int x = 0; x < k_side; ++x)
      ASSERT_NEAR(a.height_px[image.index(x, y)], b.height_px[image.index((x + 41) % k_side, (y + 67) % k_side)], 0.02);
}

TEST(ShapeFromShading, TheEnergyFallsAndTheTraceTellsTheResidual) {
  ShadingOptions options;
  options.light = {1, 0.2, 1};
  const ShadingResult result = shape_from_shading_variational(lit(reliefs()[1], options.light), options);
  ASSERT_GE(result.trace.size(), 10U);
  EXPECT_LT(result.trace.back().error, 0.02);
  EXPECT_LT(result.trace.back().error, 0.2 * result.trace.front().error);
  for (std::size_t i = 1; i < result.trace.size(); ++i) EXPECT_GE(result.trace[i].seconds, result.trace[i - 1].seconds);
}

TEST(ShapeFromShading, AlwaysFinite) {
  std::vector<GreyImage> pictures = {test::noise_image(1, 1, 1), test::noise_image(1, 17, 2),
                                     test::noise_image(23, 1, 3), test::noise_image(2, 2, 4),
                                     test::noise_image(31, 18, 5)};
  for (const double grey : {0.0, 0.5, 1.0}) pictures.push_back(test::make_image(12, 9, [=](int, int) { return grey; }));
  pictures.push_back(test::make_image(16, 16, [](int x, int y) { return (x + y) % 2 ? 1e6 : -1e6; }));
  for (const GreyImage& picture : pictures)
    for (const Vec3 light : {Vec3{0, 0, 1}, Vec3{0.01, 0.01, 1}, Vec3{1, -1, 1}, Vec3{1, 0, 1e-3}})
      for (const bool periodic : {false, true}) {
        ShadingOptions options;
        options.light = light;
        options.periodic = periodic;
        options.iterations = 40;
        for (const auto solve :
             {shape_from_shading_variational, shape_from_shading_pentland, shape_from_shading_tsai_shah})
          for (const double height : solve(picture, options).height_px) ASSERT_TRUE(std::isfinite(height));
      }
}

TEST(ShapeFromShading, FiniteUnderAnAlbedoNextToNothing) {
  for (const GreyImage& picture : {test::noise_image(31, 18, 5), test::noise_image(150, 140, 6)})
    for (const double albedo : {1e-20, 1e-60, 1e-300})
      for (const auto solve :
           {shape_from_shading_variational, shape_from_shading_pentland, shape_from_shading_tsai_shah})
        for (const int piece : {64, 2048}) {
          const ShadingResult result = solve(picture, {.albedo = albedo, .iterations = 20, .largest_piece_px = piece});
          for (const double height : result.height_px) ASSERT_TRUE(std::isfinite(height)) << albedo;
          for (const TraceSample& step : result.trace) ASSERT_TRUE(std::isfinite(step.error)) << albedo;
        }
}

TEST(ShapeFromShading, RefusesMoreStepsThanMemoryAndIntegersHold) {
  for (const auto solve : {shape_from_shading_variational, shape_from_shading_pentland, shape_from_shading_tsai_shah})
    try {
      solve(test::noise_image(8, 8, 1), {.iterations = 100'001});
      ADD_FAILURE();
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find("100001 iterations are more than 100000"), std::string::npos)
          << error.what();
    }
}

TEST(ShapeFromShading, RefusesBadArguments) {
  const GreyImage image = test::noise_image(8, 8, 1);
  for (const auto solve : {shape_from_shading_variational, shape_from_shading_pentland, shape_from_shading_tsai_shah}) {
    ShadingOptions options;
    options.light = {1, 0, 0};
    EXPECT_THROW(solve(image, options), InvalidInput);
    options = {};
    options.albedo = 0;
    EXPECT_THROW(solve(image, options), InvalidInput);
    options = {};
    options.iterations = 0;
    EXPECT_THROW(solve(image, options), InvalidInput);
    GreyImage bad = image;
    bad.at(2, 2) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(solve(bad, {}), InvalidInput);
  }
}

}  // namespace
}  // namespace papilla
