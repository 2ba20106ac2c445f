// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "papilla/core/temporary_folder.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/grain.hpp"
#include "papilla/texture/shading.hpp"
#include "papilla/texture/stein_surface.hpp"

namespace papilla {
namespace {

/// Pictures whose sides, texels and repeats are not square.
class GrainSides : public testing::Test {
 protected:
  /// 4 by 5 bumps, one every 32 columns and 20 rows.
  static GreyImage bumps() {
    GreyImage image{128, 100, {}};
    for (int y = 0; y < 100; ++y)
      for (int x = 0; x < 128; ++x) {
        const double u = std::remainder(x - 11.5, 32) / 16, v = std::remainder(y - 7.5, 20) / 10;
        image.pixels.push_back(static_cast<float>(0.2 + 0.6 * std::exp(-4 * (u * u + v * v))));
      }
    return image;
  }

  MaterialRule rule(const GreyImage& picture, double width_mm, double height_mm) const {
    MaterialRule rule;
    rule.name = "grain";
    rule.texture = folder_.path() / "grain.png";
    write_grey_image(rule.texture, picture, 8);
    rule.size_mm[0] = width_mm, rule.size_mm[1] = height_mm;
    rule.height.depth_mm = 0.2;
    rule.height.max_slope = 1000;
    rule.static_friction = rule.dynamic_friction = 0.5;
    return rule;
  }

  /// Grey that grows from row to row and from column to column.
  MapRule map(int width, int height) const {
    GreyImage grey{width, height, {}};
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) grey.pixels.push_back(static_cast<float>(0.5 * x / width + 0.5 * y / height));
    MapRule map;
    map.picture = folder_.path() / "map.png";
    map.recipe = "map.png";
    write_grey_image(map.picture, grey, 8);
    return map;
  }

  const TemporaryFolder folder_{"papilla-grain-sides"};
};

TEST_F(GrainSides, AWholePictureHasThePitchesOfItsSides) {
  MaterialRule whole = rule(bumps(), 64, 20);
  whole.height.relief.tile = false;
  const Grain grain = make_grain(whole);
  EXPECT_DOUBLE_EQ(grain.relief.pitch_mm_x, 0.5);
  EXPECT_DOUBLE_EQ(grain.relief.pitch_mm_y, 0.2);
  EXPECT_DOUBLE_EQ(grain.size_mm[0], 64);
  EXPECT_DOUBLE_EQ(grain.size_mm[1], 20);
}

/// A tile of some repeats; what is mapped over the whole picture is mapped over it still.
TEST_F(GrainSides, ATileHasTheSidesOfItsRepeats) {
  MaterialRule tiled = rule(bumps(), 64, 20);
  tiled.height.relief.tile = true;
  tiled.maps[Quantity::dynamic_friction] = map(64, 50);
  const Grain grain = make_grain(tiled);
  const int width = grain.relief.width, height = grain.relief.height;
  ASSERT_EQ(width, 32);
  ASSERT_TRUE(height == 20 || height == 40) << height;
  EXPECT_DOUBLE_EQ(grain.relief.pitch_mm_y, 0.2);
  EXPECT_DOUBLE_EQ(grain.size_mm[0], 0.5 * width);
  EXPECT_DOUBLE_EQ(grain.size_mm[1], 0.2 * height);
  ASSERT_TRUE(grain.tag.maps);
  EXPECT_DOUBLE_EQ(grain.tag.maps->uv_transform.scale.x, width / 128.0);
  EXPECT_DOUBLE_EQ(grain.tag.maps->uv_transform.scale.y, height / 100.0);
}

/// Texels of less than 0.1 mm are averaged: columns of 0.05 mm would be if rows were as near.
TEST_F(GrainSides, MapsHaveThePitchesOfBothSides) {
  MaterialRule mapped = rule(bumps(), 6.4, 25.6);
  mapped.height.relief.tile = false;
  mapped.maps[Quantity::dynamic_friction] = map(128, 128);
  const Grain coarse = make_grain(mapped);
  ASSERT_TRUE(coarse.tag.maps);
  EXPECT_EQ(coarse.tag.maps->size, (std::array<int, 2>{128, 128}));
  mapped.size_mm[1] = 6.4;
  const Grain fine = make_grain(mapped);
  ASSERT_TRUE(fine.tag.maps);
  EXPECT_EQ(fine.tag.maps->size, (std::array<int, 2>{64, 64}));
}

TEST_F(GrainSides, ARecipeHasThePitchesOfItsSides) {
  MaterialRule computed = rule(bumps(), 40, 10);
  computed.recipe = computed.texture = "oak";
  const Grain grain = make_grain(computed);
  EXPECT_DOUBLE_EQ(grain.relief.pitch_mm_x, 40.0 / grain.relief.width);
  EXPECT_DOUBLE_EQ(grain.relief.pitch_mm_y, 10.0 / grain.relief.height);
}

TEST_F(GrainSides, PhotographsHaveThePitchesOfTheirSides) {
  HeightMap relief{64, 48, {}, 0.1, 0.1, false};
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x)
      relief.mm.push_back(static_cast<float>(0.1 * std::sin(0.21 * x + 0.1 * y) * std::cos(0.17 * y)));
  MaterialRule seen = rule(bumps(), 20, 6);
  seen.height.lights = {{{0.6, 0.1, 0.8}, {-0.5, 0.4, 0.8}, {-0.1, -0.7, 0.7}, {0.3, 0.6, 0.7}}, {}, "lights"};
  for (const Vec3 light : seen.height.lights.directions) {
    seen.height.images.push_back(folder_.path() / ("light" + std::to_string(seen.height.images.size()) + ".tif"));
    write_grey_image(seen.height.images.back(), render_lambert(relief, light), 32);
  }
  seen.texture = seen.height.images.front();
  const Grain grain = make_grain(seen);
  EXPECT_DOUBLE_EQ(grain.relief.pitch_mm_x, 20.0 / 64);
  EXPECT_DOUBLE_EQ(grain.relief.pitch_mm_y, 6.0 / 48);
}

TEST_F(GrainSides, RoughnessHasNoWavesLongerThanTheShorterSide) {
  MaterialRule rough = rule(bumps(), 64, 20);
  rough.height.relief.tile = false;
  rough.fine_roughness = RoughnessModel{.hurst = 0.6, .rms_mm = 1e-3, .shortest_mm = 0.5, .longest_mm = 100};
  const Grain grain = make_grain(rough);
  ASSERT_TRUE(grain.height.overlay);
  EXPECT_DOUBLE_EQ(grain.height.overlay->longest_mm, 20);
}

/// Bumps under a Brownian surface, whose roughness is laid over them.
TEST_F(GrainSides, RoughnessIsScaledAsTheReliefIs) {
  const HeightGrid fractal = brownian_surface_exact({257, 0.3, 4});
  const GreyImage cells = bumps();
  GreyImage image{256, 240, {}};
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 256; ++x)
      image.pixels.push_back(0.2F + 0.5F * cells.at(x % 128, y % 100) + 0.05F * static_cast<float>(fractal.at(x, y)));
  MaterialRule whole = rule(image, 25.6, 36);
  whole.height.relief.tile = false;
  const Grain once = make_grain(whole);
  whole.height.scale = 2;
  const Grain twice = make_grain(whole);
  ASSERT_TRUE(once.height.overlay && twice.height.overlay);
  EXPECT_GT(once.height.overlay->rms_mm, 0);
  EXPECT_DOUBLE_EQ(twice.height.overlay->rms_mm, 2 * once.height.overlay->rms_mm);
  EXPECT_DOUBLE_EQ(twice.height.overlay->rms_slope, 2 * once.height.overlay->rms_slope);
}

}  // namespace
}  // namespace papilla
