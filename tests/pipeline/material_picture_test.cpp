// SPDX-License-Identifier: MIT
#include "papilla/pipeline/pictures/material_picture.hpp"

#include <gtest/gtest.h>

#include <array>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

MaterialRule plain(const std::string& colour) {
  MaterialRule rule;
  rule.name = "m";
  rule.stiffness = 900;
  rule.color = colour;
  rule.roughness = 0.9;
  rule.metallic = 0;
  return rule;
}

std::array<int, 3> pixel(const ColorImage& image, int x, int y) {
  const auto at = 3 * static_cast<std::size_t>(y * image.width + x);
  return {image.pixels[at], image.pixels[at + 1], image.pixels[at + 2]};
}

TEST(MaterialPicture, ShowsTheColourOnALitBall) {
  const ColorImage picture = material_picture(plain("#c02020"), {.side_px = 96});
  EXPECT_EQ(picture.width, 192);
  EXPECT_EQ(picture.height, 96);
  const auto middle = pixel(picture, 48, 48), corner = pixel(picture, 2, 2);
  EXPECT_GT(middle[0], 2 * middle[1]);
  EXPECT_GT(corner[1], 200) << "the background";
  // Lit from above.
  EXPECT_GT(pixel(picture, 48, 30)[0], pixel(picture, 48, 80)[0]);
  // Without relief the right half is even.
  EXPECT_EQ(pixel(picture, 100, 10), pixel(picture, 180, 90));
}

TEST(MaterialPicture, ShowsTheReliefAtItsRightAspect) {
  MaterialRule rule = plain("#808080");
  rule.recipe = "grain:ovals8";
  rule.texture = rule.recipe;
  rule.size_mm[0] = 20;
  rule.size_mm[1] = 10;
  rule.height.depth_mm = 0.2;
  rule.show = "relief";
  const ColorImage picture = material_picture(rule, {.side_px = 128});
  // Twice as wide as high: even strips above and below.
  EXPECT_EQ(pixel(picture, 130, 2), pixel(picture, 250, 120));
  int changes = 0;
  for (int x = 130; x < 255; ++x) changes += pixel(picture, x, 64) != pixel(picture, x - 1, 64) ? 1 : 0;
  EXPECT_GT(changes, 60);
  EXPECT_EQ(picture.pixels, material_picture(rule, {.side_px = 128}).pixels);
}

TEST(MaterialPicture, RefusesASideOutOfRange) {
  EXPECT_THROW(material_picture(plain("#000000"), {.side_px = 63}), InvalidInput);
  EXPECT_THROW(material_picture(plain("#000000"), {.side_px = 2049}), InvalidInput);
}

}  // namespace
}  // namespace papilla
