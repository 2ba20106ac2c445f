// SPDX-License-Identifier: MIT
#include "papilla/texture/height_from_image.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/texture/grain.hpp"
#include "papilla/texture/roughness.hpp"
#include "papilla/texture/shading.hpp"
#include "papilla/texture/stein_surface.hpp"
#include "papilla/texture/tiling.hpp"
#include "texture/bent_pattern.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

double correlation(const HeightMap& a, const HeightMap& b) {
  double mean_a = 0, mean_b = 0, ab = 0, aa = 0, bb = 0;
  const auto n = static_cast<double>(a.mm.size());
  for (std::size_t i = 0; i < a.mm.size(); ++i) {
    mean_a += static_cast<double>(a.mm[i]) / n;
    mean_b += static_cast<double>(b.mm[i]) / n;
  }
  for (std::size_t i = 0; i < a.mm.size(); ++i) {
    const double u = static_cast<double>(a.mm[i]) - mean_a, v = static_cast<double>(b.mm[i]) - mean_b;
    ab += u * v;
    aa += u * u;
    bb += v * v;
  }
  return ab / std::sqrt(aa * bb);
}

TEST(HeightFromImage, GivesBackTheReliefOfALitGrain) {
  for (const GrainKind kind : {GrainKind::spheres6, GrainKind::quads6, GrainKind::ovals6}) {
    const GrainResult grain = synthesize_grain(kind, {192});
    const HeightResult result = height_from_image(grain.picture);  // Everything automatic.
    EXPECT_EQ(result.method, HeightMethod::wiener) << to_string(kind);
    EXPECT_TRUE(result.map.periodic) << to_string(kind);
    EXPECT_TRUE(result.light_estimated);
    EXPECT_GT(correlation(result.map, grain.relief), 0.75) << to_string(kind);
    // The true light in place of the estimated one.
    const HeightResult lit = height_from_image(grain.picture, {.light = GrainOptions{}.light});
    EXPECT_FALSE(lit.light_estimated);
    EXPECT_GT(correlation(lit.map, grain.relief), 0.8) << to_string(kind);
    EXPECT_FALSE(result.trace.empty());
  }
}

TEST(HeightFromImage, HasTheDepthAskedFor) {
  const HeightResult result = height_from_image(synthesize_grain(GrainKind::spheres6, {96}).picture, {.depth_mm = 0.7});
  const auto [low, high] = std::minmax_element(result.map.mm.begin(), result.map.mm.end());
  EXPECT_EQ(*low, 0);
  EXPECT_NEAR(*high, 0.7, 1e-6);
  EXPECT_EQ(result.depth_mm, 0.7);
  EXPECT_DOUBLE_EQ(result.rms_mm, rms_height_mm(result.map));
  EXPECT_NEAR(result.map.pitch_mm_x, 40.0 / 96, 1e-12);
}

TEST(HeightFromImage, DisorderedPicturesAreReadAsHeights) {
  const GreyImage image = to_grey_image(brownian_surface_exact({97, 0.5, 2}));
  const HeightResult result = height_from_image(image, {.pitch_mm = 0.1, .depth_mm = 2});
  EXPECT_EQ(result.method, HeightMethod::intensity);
  EXPECT_FALSE(result.map.periodic);
  EXPECT_DOUBLE_EQ(result.shortest_wavelength_mm, 0.2);  // Nothing was cut: two pixels.
  for (std::size_t i = 0; i < image.pixels.size(); ++i) ASSERT_NEAR(result.map.mm[i], 2 * image.pixels[i], 1e-6);
}

TEST(HeightFromImage, RoughnessIsKeptApartFromTheRelief) {
  GrainResult grain = synthesize_grain(GrainKind::quads6, {.size_px = 192});
  const GreyImage noise = test::noise_image(192, 192, 4);
  for (std::size_t i = 0; i < noise.pixels.size(); ++i) grain.picture.pixels[i] += 0.1F * (noise.pixels[i] - 0.5F);
  HeightOptions options;
  options.light = GrainOptions{}.light;
  options.periodic = true;
  options.method = HeightMethod::variational;
  options.roughness = HeightRoughness::none;
  const HeightResult relief = height_from_image(grain.picture, options);
  options.roughness = HeightRoughness::residual;
  const HeightResult residual = height_from_image(grain.picture, options);
  options.roughness = HeightRoughness::synthesized;
  const HeightResult synthesized = height_from_image(grain.picture, options);
  EXPECT_EQ(relief.roughness_rms_mm, 0);
  EXPECT_GT(residual.roughness_rms_mm, 0.002);
  EXPECT_NEAR(synthesized.roughness_rms_mm, residual.roughness_rms_mm, 0.2 * residual.roughness_rms_mm);
  for (const HeightResult* result : {&relief, &residual, &synthesized}) {
    EXPECT_TRUE(result->map.periodic);
    EXPECT_NEAR(result->depth_mm, 0.3, 1e-12);
    EXPECT_FALSE(result->assumed.empty());
  }
  EXPECT_EQ(residual.roughness, HeightRoughness::residual);
}

/// Waves of 16 pixels under a Brownian surface. Two heights 16 pixels apart differ by their roughness alone. With H =
/// 0.7 these differences have a correlation of 0.84 from pixel to pixel where amplitudes fall as 1 / frequency^(1 + H)
/// from 20 pixels on, and one of 0.36 where they fall as 1 / frequency^H.
TEST(HeightFromImage, SynthesizedRoughnessFallsAsThatOfTheResidual) {
  const GreyImage fractal = to_grey_image(brownian_surface_exact({192, 0.7, 3}));
  const double k = 2 * std::numbers::pi / 16;
  const GreyImage image = test::make_image(192, 192, [&](int x, int y) {
    return 0.4 + 0.15 * (std::cos(k * x) + std::cos(k * y)) + 0.2 * static_cast<double>(fractal.at(x, y));
  });
  const HeightResult result = height_from_image(
      image,
      {.method = HeightMethod::intensity, .pitch_mm = 0.05, .depth_mm = 2, .roughness = HeightRoughness::synthesized});
  ASSERT_EQ(result.roughness, HeightRoughness::synthesized);
  const auto difference = [&](int x, int y) {
    return static_cast<double>(result.map.at(x + 16, y)) - static_cast<double>(result.map.at(x, y));
  };
  double product = 0, square = 0;
  for (int y = 0; y < 192; ++y)
    for (int x = 0; x < 175; ++x) {
      product += difference(x, y) * difference(x + 1, y);
      square += difference(x, y) * difference(x, y);
    }
  EXPECT_GT(product / square, 0.65);
  EXPECT_LT(product / square, 0.95);
}

TEST(HeightFromImage, CutLeavesNoShorterWave) {
  // Waves of 24 and of 4 pixels; the cut at 6 pixels leaves the first alone.
  const double k = 2 * 3.141592653589793;
  const GreyImage image = test::make_image(
      96, 96, [&](int x, int y) { return 0.5 + 0.2 * std::sin(k * x / 24) + 0.2 * std::sin(k * y / 4); });
  const HeightResult result = height_from_image(image, {.method = HeightMethod::intensity,
                                                        .pitch_mm = 0.1,
                                                        .depth_mm = 0.4,
                                                        .periodic = true,
                                                        .shortest_wavelength_mm = 0.6});
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 96; ++x) ASSERT_NEAR(result.map.at(x, y), 0.2 + 0.2 * std::sin(k * x / 24), 1e-5);
  EXPECT_EQ(result.shortest_wavelength_mm, 0.6);
  EXPECT_THROW(height_from_image(image, {.method = HeightMethod::intensity, .shortest_wavelength_mm = 0.6}),
               InvalidInput);
  EXPECT_DOUBLE_EQ(shortest_playable_wavelength_mm(100, 1000), 0.2);
}

TEST(HeightFromImage, WhatRunsAcrossTheLightIsGuessed) {
  const double k = 2 * 3.141592653589793 / 24;
  const GreyImage image = test::make_image(96, 96, [&](int x, int) { return 0.7 + 0.1 * std::cos(k * x); });
  HeightOptions options{.method = HeightMethod::pentland, .light = Vec3{1, 0, 1}, .periodic = true};
  EXPECT_LT(height_from_image(image, options).guessed_share, 0.01);
  options.light = Vec3{0.05, 1, 1};
  EXPECT_GT(height_from_image(image, options).guessed_share, 0.9);
}

/// Under a light at 45 degrees a matt surface may be 1.41 times as bright as level ground: 1.68 times is a
/// highlight, 1.28 is none. Both have a sixteenth of the picture, and so has what lies in shadow.
TEST(HeightFromImage, HighlightsAreBrighterThanWhatFacesTheLight) {
  const GreyImage image = test::make_image(96, 32, [](int x, int) {
    return x % 16 == 0 ? 0.65 : x % 16 == 8 ? 0.85 : x % 16 == 4 ? 0.1 : 0.5;
  });
  const HeightResult result = height_from_image(
      image,
      {.method = HeightMethod::pentland, .light = Vec3{1, 0, 1}, .periodic = true, .transfer = Transfer::linear});
  EXPECT_NEAR(result.highlights_fraction, 1.0 / 16, 1e-9);
  EXPECT_NEAR(result.shadows_fraction, 1.0 / 16, 1e-9);
}

/// A lit lattice of bumps, turned: no whole number of cells fits the picture.
GreyImage turned_grain(double angle_deg) {
  const double angle = angle_deg * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  const HeightMap relief = test::make_relief(230, 210, 1, [&](int x, int y) {
    const double u = 2 * std::numbers::pi * (c * x + s * y) / 23.4, v = 2 * std::numbers::pi * (c * y - s * x) / 19.7;
    return 1.5 * (std::cos(u) + std::cos(v) + 0.5 * std::sin(u + v));
  });
  return render_lambert(relief, {1, 0.4, 1});
}

TEST(HeightFromImage, TurnedLatticesTile) {
  for (const double angle : {0.0, 11.0, 27.0}) {
    const HeightResult result = height_from_image(turned_grain(angle), {.light = Vec3{1, 0.4, 1}, .tile = true});
    ASSERT_TRUE(result.tile) << angle;
    EXPECT_LE(result.tile->strain, 0.011);
    EXPECT_TRUE(result.map.periodic);
    EXPECT_EQ(result.map.width, result.tile->width);
    EXPECT_EQ(result.roughness, HeightRoughness::synthesized);
    const GreyImage heights{result.map.width, result.map.height, result.map.mm, 0, 32};
    EXPECT_TRUE(measure_tiling(heights).tiles) << angle;
  }
}

using Waves = std::vector<std::complex<double>>;

/// Fourier transform of every row of `rows` values, and turned, so that two make that of a picture.
Waves transformed_rows(const Waves& values, int columns, int rows) {
  Waves result;
  for (int u = 0; u < columns; ++u)
    for (int y = 0; y < rows; ++y) {
      std::complex<double> sum;
      for (int x = 0; x < columns; ++x)
        sum += values[static_cast<std::size_t>(y * columns + x)] *
               std::polar(1.0, -2 * std::numbers::pi * (u * x % columns) / columns);
      result.push_back(sum);
    }
  return result;
}

/// Amplitudes of a periodic map's waves, the largest first; every wave has its opposite beside it.
std::vector<double> amplitudes(const HeightMap& map) {
  Waves waves(map.mm.begin(), map.mm.end());
  waves = transformed_rows(transformed_rows(waves, map.width, map.height), map.height, map.width);
  waves.front() = 0;
  std::vector<double> result;
  for (const std::complex<double>& wave : waves) result.push_back(std::abs(wave));
  std::sort(result.begin(), result.end(), std::greater<>());
  return result;
}

TEST(HeightFromImage, TheTileOfALatticeThatBendsIsItsOwnCell) {
  const HeightResult result = height_from_image(
      test::bent_pattern(1), {.method = HeightMethod::intensity, .roughness = HeightRoughness::none, .tile = true});
  ASSERT_TRUE(result.tile);
  const std::vector<double> found = amplitudes(result.map);
  // A mean over cells that lie askew would lose the short waves first: 0.37 of the last one.
  EXPECT_NEAR(found[2] / found[0], 0.10 / 0.12, 0.06);
  EXPECT_NEAR(found[4] / found[0], 0.08 / 0.12, 0.06);
  EXPECT_NEAR(found[6] / found[0], 0.06 / 0.12, 0.06);
  EXPECT_LT(found[8] / found[0], 0.06);
}

TEST(HeightFromImage, TilesNeedALattice) {
  EXPECT_THROW(height_from_image(test::noise_image(96, 96, 9), {.tile = true}), InvalidInput);
}

TEST(HeightFromImage, OppositeLightOnTheOppositeReliefIsTheSamePicture) {
  const HeightMap relief = test::make_relief(
      40, 30, 0.1, [](int x, int y) { return 0.2 * std::sin(0.3 * x) * std::cos(0.4 * y) + 0.01 * x; });
  const GreyImage one = render_lambert(relief, {0.6, -0.3, 1}),
                  other = render_lambert(opposite_relief(relief), {-0.6, 0.3, 1});
  for (std::size_t i = 0; i < one.pixels.size(); ++i) ASSERT_NEAR(one.pixels[i], other.pixels[i], 1e-5);
  const auto [low, high] = std::minmax_element(relief.mm.begin(), relief.mm.end());
  const HeightMap opposite = opposite_relief(relief);
  EXPECT_FLOAT_EQ(*std::min_element(opposite.mm.begin(), opposite.mm.end()), *low);
  EXPECT_FLOAT_EQ(*std::max_element(opposite.mm.begin(), opposite.mm.end()), *high);
}

TEST(HeightFromImage, UnknownPitchStaysUnknown) {
  GreyImage image = test::noise_image(40, 40, 1);
  EXPECT_EQ(height_from_image(image).map.pitch_mm_x, 0);
  image.pitch_mm = 0.25;
  EXPECT_EQ(height_from_image(image).map.pitch_mm_x, 0.25);
  EXPECT_EQ(height_from_image(image, {.pitch_mm = 0.5}).map.pitch_mm_y, 0.5);
}

TEST(HeightFromImage, FlatAndBlackPicturesAreFlat) {
  for (const double grey : {0.0, 0.5, 1.0})
    for (const HeightMethod method :
         {HeightMethod::automatic, HeightMethod::variational, HeightMethod::tsai_shah, HeightMethod::intensity}) {
      const HeightResult result =
          height_from_image(test::make_image(20, 15, [=](int, int) { return grey; }), {.method = method});
      EXPECT_EQ(result.depth_mm, 0);
      EXPECT_EQ(result.rms_mm, 0);
      for (const float height : result.map.mm) EXPECT_EQ(height, 0);
    }
}

TEST(HeightFromImage, AlwaysFinite) {
  for (const auto& [w, h] : {std::pair{1, 1}, std::pair{1, 30}, std::pair{30, 1}, std::pair{3, 2}, std::pair{33, 20}})
    for (const HeightMethod method : {HeightMethod::variational, HeightMethod::tsai_shah, HeightMethod::intensity})
      for (const Vec3 light : {Vec3{0, 0, 1}, Vec3{1, -1, 0.01}}) {
        const HeightResult result = height_from_image(test::noise_image(w, h, 3), {.method = method, .light = light});
        for (const float height : result.map.mm) ASSERT_TRUE(std::isfinite(height));
      }
}

TEST(HeightFromImage, RefusesBadArguments) {
  const GreyImage image = test::noise_image(8, 8, 1);
  EXPECT_THROW(height_from_image(GreyImage{}), InvalidInput);
  EXPECT_THROW(height_from_image(image, {.depth_mm = 0}), InvalidInput);
  EXPECT_THROW(height_from_image(image, {.pitch_mm = -1}), InvalidInput);
  EXPECT_THROW(height_from_image(image, {.method = HeightMethod::variational, .light = Vec3{0, 0, -1}}), InvalidInput);
  EXPECT_THROW(height_from_image(image, {.method = HeightMethod::photometric_stereo}), InvalidInput);
  GreyImage bad = image;
  bad.at(5, 5) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(height_from_image(bad), InvalidInput);
  EXPECT_THROW(height_method("magic"), InvalidInput);
  EXPECT_EQ(height_method("tsai-shah"), HeightMethod::tsai_shah);
  EXPECT_EQ(to_string(HeightMethod::automatic), "auto");
  EXPECT_EQ(to_string(HeightMethod::photometric_stereo), "photometric-stereo");
}

}  // namespace
}  // namespace papilla
