// SPDX-License-Identifier: MIT
#include "papilla/texture/picture_relief.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "papilla/core/error.hpp"
#include "papilla/texture/grain.hpp"
#include "papilla/texture/stein_surface.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

PictureRelief relief_of(const GreyImage& image, const PictureReliefOptions& options = {}) {
  return relief_of_picture(image, read_texture(image), options);
}

bool ran(const PictureRelief& relief, std::string_view step) { return step_of(relief.plan, step).run; }

/// Bumps on an oblong, oblique lattice, with noise of its own in every pixel.
GreyImage noisy_bumps(double noise) {
  const GreyImage grain = test::noise_image(300, 220, 9);
  GreyImage image = test::make_image(300, 220, [&](int x, int y) {
    const double u = 2 * std::numbers::pi * (x / 23.0 + y / 61.0), v = 2 * std::numbers::pi * y / 17.0;
    return 0.5 + 0.2 * std::cos(u) + 0.15 * std::cos(v) + noise * (static_cast<double>(grain.at(x, y)) - 0.5);
  });
  image.pitch_mm = 0.1;
  return image;
}

TEST(ReliefOfPicture, WhatRepeatsIsMadeOnceOnAnExactTile) {
  PictureReliefOptions options;
  options.height.method = HeightMethod::intensity;
  options.height.depth_mm = 0.4;
  const PictureRelief relief = relief_of(noisy_bumps(0.3), options);
  ASSERT_TRUE(relief.height.tile);
  EXPECT_TRUE(relief.height.map.periodic);
  EXPECT_LT(relief.height.map.width * relief.height.map.height, 300 * 220);
  EXPECT_FALSE(relief.roughness);
  EXPECT_TRUE(ran(relief, "exact_tile") && ran(relief, "primitive"));
  EXPECT_FALSE(ran(relief, "roughness") || ran(relief, "fractal_synthesis"));
  // The noise is averaged away: neighbours differ by no more than the waves do.
  const HeightMap& map = relief.height.map;
  double most = 0;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      most = std::max(
          most, std::abs(static_cast<double>(map.at((x + 1) % map.width, y)) - static_cast<double>(map.at(x, y))));
  EXPECT_LT(most, 0.4 * 0.25);
}

TEST(ReliefOfPicture, APictureThatIsSeenKeepsItsFrame) {
  PictureReliefOptions options;
  options.height.method = HeightMethod::intensity;
  options.seen = true;
  const PictureRelief relief = relief_of(noisy_bumps(0.3), options);
  EXPECT_FALSE(relief.height.tile);
  EXPECT_EQ(relief.height.map.width, 300);
  EXPECT_EQ(relief.height.map.height, 220);
  EXPECT_FALSE(ran(relief, "exact_tile"));
}

GreyImage rough_picture(double hurst) {
  GreyImage image = to_grey_image(brownian_surface_exact({193, hurst, 4}));
  image.pitch_mm = 0.1;
  return image;
}

TEST(ReliefOfPicture, WhatIsDisorderedAndDoesNotTileBecomesASurfaceLikeIt) {
  PictureReliefOptions options;
  options.height.depth_mm = 0.2;
  options.source = ReliefSource::synthesis;
  const GreyImage image = rough_picture(0.6);
  const PictureRelief relief = relief_of(image, options);
  ASSERT_TRUE(relief.like);
  EXPECT_TRUE(relief.height.map.periodic);
  EXPECT_TRUE(ran(relief, "fractal_synthesis"));
  EXPECT_FALSE(relief.roughness);
  // σ as in the picture, whose grey range of 1 is the depth.
  double mean = 0, squares = 0;
  for (const float grey : image.pixels) mean += static_cast<double>(grey) / static_cast<double>(image.pixels.size());
  for (const float grey : image.pixels) squares += std::pow(static_cast<double>(grey) - mean, 2);
  EXPECT_NEAR(relief.height.rms_mm, 0.2 * std::sqrt(squares / static_cast<double>(image.pixels.size())), 1e-4);

  options.source = ReliefSource::picture;
  const PictureRelief own = relief_of(image, options);
  EXPECT_FALSE(own.like);
  EXPECT_EQ(own.height.map.width, 193);
  EXPECT_FALSE(ran(own, "fractal_synthesis"));
  EXPECT_EQ(step_of(own.plan, "fractal_synthesis").reason, "the picture's own relief is asked for");
}

/// A bent wave of 4 mm under a self-affine surface.
TEST(ReliefOfPicture, WeakOrderIsReliefAndRoughnessApart) {
  const HeightGrid surface = brownian_surface_exact({257, 0.4, 2});
  GreyImage image = test::make_image(256, 256, [&](int x, int y) {
    return 0.5 + 0.004 * surface.at(x, y) + 0.15 * std::sin(0.157 * y + 0.8 * std::sin(0.043 * x));
  });
  image.pitch_mm = 0.1;
  PictureReliefOptions options;
  options.height.method = HeightMethod::intensity;
  TextureReading reading = read_texture(image);
  reading.kind.kind = TextureKind::weakly_ordered;
  reading.plan = plan_analysis(reading.kind, {});
  const PictureRelief parted = relief_of_picture(image, reading, options);
  ASSERT_TRUE(parted.roughness) << step_of(parted.plan, "roughness").reason;
  EXPECT_GT(parted.roughness->rms_mm, 0);
  EXPECT_LT(parted.height.depth_mm, 0.3);
  options.part = false;
  const PictureRelief whole = relief_of_picture(image, reading, options);
  EXPECT_FALSE(whole.roughness);
  EXPECT_NEAR(whole.height.depth_mm, 0.3, 1e-6);
  EXPECT_GT(whole.height.rms_mm, parted.height.rms_mm);
}

TEST(ReliefOfPicture, FlatPicturesGiveFlatReliefs) {
  const PictureRelief relief = relief_of(test::make_image(70, 90, [](int, int) { return 0.25; }));
  EXPECT_EQ(relief.height.depth_mm, 0);
  EXPECT_FALSE(relief.roughness || relief.like);
}

TEST(ReliefSource, HasNames) {
  for (const ReliefSource source : {ReliefSource::automatic, ReliefSource::picture, ReliefSource::synthesis})
    EXPECT_EQ(relief_source(to_string(source)), source);
  EXPECT_THROW(relief_source("both"), InvalidInput);
}

}  // namespace
}  // namespace papilla
