// SPDX-License-Identifier: MIT
#include "papilla/texture/prepare.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "papilla/core/error.hpp"
#include "papilla/texture/grain.hpp"
#include "papilla/texture/spectral_surface.hpp"
#include "texture/bent_pattern.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

/// A rough picture under light that fades to the right.
GreyImage faded(int width, int height) {
  const HeightGrid surface = spectral_surface({.size = 256, .hurst = 0.3, .longest_wavelength_px = 24});
  return test::make_image(width, height, [&](int x, int y) {
    return 0.8 - 0.5 * x / width + 0.05 * (1 - 0.4 * x / width) * surface.at(x % 256, y % 256);
  });
}

TEST(Prepare, TakesGradientsAway) {
  const PreparedPicture prepared = prepare_picture(faded(200, 180));
  EXPECT_GT(prepared.before.gradient, 2);
  EXPECT_LT(prepared.after.gradient, 0.5);
  EXPECT_LT(prepared.after.contrast_ratio, 1.5);
}

TEST(Prepare, CutMakesPicturesTile) {
  for (const auto& [width, height] : {std::pair{200, 180}, std::pair{131, 240}}) {
    const PreparedPicture prepared = prepare_picture(faded(width, height));
    EXPECT_FALSE(prepared.before.tiling.tiles);
    EXPECT_TRUE(prepared.after.tiling.tiles) << prepared.after.tiling.seam_x << " " << prepared.after.tiling.seam_y;
    EXPECT_LT(prepared.image.width, width);
    EXPECT_GE(prepared.image.width, width * 3 / 4);
    EXPECT_GE(prepared.image.height, height * 3 / 4);
  }
}

TEST(Prepare, CutKeepsThePeriodsOfALattice) {
  // 9.4 periods of 20 pixels a side: the overlap must leave a whole number of them.
  const GreyImage image = test::make_image(188, 188, [](int x, int y) {
    const double k = 2 * 3.141592653589793 / 20;
    return 0.5 + 0.2 * std::cos(k * x) * std::cos(k * y) + 0.1 * std::sin(k * x + 1);
  });
  const PreparedPicture prepared = prepare_picture(image, {.flatten = false});
  EXPECT_EQ(prepared.image.width % 20, 0);
  EXPECT_EQ(prepared.image.height % 20, 0);
  EXPECT_TRUE(prepared.after.tiling.tiles);
}

TEST(Prepare, MirrorDoublesAndTiles) {
  const PreparedPicture prepared = prepare_picture(faded(60, 50), {.borders = BorderMatching::mirror});
  EXPECT_EQ(prepared.image.width, 120);
  EXPECT_EQ(prepared.image.height, 100);
  EXPECT_TRUE(prepared.after.tiling.tiles);
  for (int y = 0; y < 100; ++y) EXPECT_EQ(prepared.image.at(0, y), prepared.image.at(119, y));
}

TEST(Prepare, PicturesThatTileKeepTheirSize) {
  const GreyImage grain = synthesize_grain(GrainKind::spheres6, {.size_px = 120}).picture;
  const PreparedPicture prepared = prepare_picture(grain, {.flatten = false});
  EXPECT_EQ(prepared.image.width, 120);
  EXPECT_NEAR(*std::max_element(prepared.image.pixels.begin(), prepared.image.pixels.end()), 1, 1e-6);
  EXPECT_NEAR(*std::min_element(prepared.image.pixels.begin(), prepared.image.pixels.end()), 0, 1e-6);
}

TEST(Prepare, KnotsAreReported) {
  const GreyImage noise = test::noise_image(160, 160, 2);
  const GreyImage knot = test::make_image(160, 160, [&](int x, int y) {
    const double there = std::exp(-((x - 70) * (x - 70) + (y - 110) * (y - 110)) / 100.0);
    return 0.4 + 0.2 * static_cast<double>(noise.at(x, y)) + 0.4 * there;
  });
  EXPECT_EQ(measure_picture(noise).knots, 0);
  EXPECT_GE(measure_picture(knot).knots, 1);
  const PreparedPicture prepared = prepare_picture(knot, {.borders = BorderMatching::none});
  EXPECT_TRUE(std::any_of(prepared.warnings.begin(), prepared.warnings.end(),
                          [](const std::string& w) { return w.find("knot") != std::string::npos; }));
}

TEST(Prepare, StraightensALatticeThatBends) {
  const GreyImage bent = test::bent_pattern(1);
  PrepareOptions options{.flatten = false, .borders = BorderMatching::none, .contrast = false};
  EXPECT_EQ(prepare_picture(bent, options).image.pixels, bent.pixels);
  options.straighten = true;
  const PreparedPicture prepared = prepare_picture(bent, options);
  ASSERT_FALSE(prepared.steps.empty());
  EXPECT_EQ(prepared.steps.front().name, "straighten");
  EXPECT_TRUE(prepared.steps.front().run);
  EXPECT_LT(prepared.image.width, bent.width);  // Without the rim that came from beyond the borders.
  EXPECT_LT(test::irregularity(prepared.image), 0.5 * test::irregularity(bent));
}

TEST(Prepare, LeavesAStraightLatticeStraight) {
  const GreyImage straight = test::bent_pattern(0);
  const PreparedPicture prepared = prepare_picture(
      straight, {.straighten = true, .flatten = false, .borders = BorderMatching::none, .contrast = false});
  EXPECT_FALSE(prepared.steps.front().run);
  EXPECT_EQ(prepared.image.pixels, straight.pixels);
}

TEST(Prepare, PlasticityRaisesContrast) {
  const GreyImage image = faded(100, 100);
  const PrepareOptions plain{.flatten = false, .borders = BorderMatching::none, .contrast = false};
  PrepareOptions raised = plain;
  raised.plasticity = 2;
  EXPECT_EQ(prepare_picture(image, plain).image.pixels, image.pixels);
  EXPECT_GT(prepare_picture(image, raised).after.contrast, prepare_picture(image, plain).after.contrast);
}

TEST(Prepare, BadPicturesAndOptions) {
  const PreparedPicture flat = prepare_picture(test::make_image(20, 20, [](int, int) { return 0.5; }));
  for (const float grey : flat.image.pixels) EXPECT_TRUE(std::isfinite(grey));
  EXPECT_THROW(prepare_picture(test::noise_image(15, 40, 1)), InvalidInput);
  EXPECT_THROW(prepare_picture(test::noise_image(20, 20, 1), {.plasticity = -1}), InvalidInput);
  EXPECT_THROW(prepare_picture(test::noise_image(20, 20, 1), {.flatten_px = std::nan("")}), InvalidInput);
  EXPECT_EQ(border_matching("cut"), BorderMatching::cut);
  EXPECT_THROW(border_matching("glue"), InvalidInput);
}

}  // namespace
}  // namespace papilla
