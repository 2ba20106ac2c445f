// SPDX-License-Identifier: MIT
#include "papilla/texture/resample.hpp"

#include <gtest/gtest.h>

#include "papilla/core/error.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

TEST(Crop, TakesThePixelsAskedFor) {
  GreyImage image = test::make_image(
      7, 5, [](int x, int y) { return 10 * y + x; }, 8);
  image.pitch_mm = 0.25;
  const GreyImage part = crop(image, 2, 1, 3, 2);
  EXPECT_EQ(part.pixels, (Values<float>{12, 13, 14, 22, 23, 24}));
  EXPECT_EQ(part.pitch_mm, 0.25);
  EXPECT_EQ(part.bits, 8);
  const GreyImage middle = middle_part(image, 3);
  EXPECT_EQ(middle.width, 3);
  EXPECT_EQ(middle.height, 3);
  EXPECT_EQ(middle.at(0, 0), 12);
  EXPECT_EQ(middle_part(image, 100).pixels, image.pixels);
}

TEST(Crop, RefusesWhatIsNotThere) {
  const GreyImage image = test::noise_image(7, 5, 1);
  EXPECT_THROW(crop(image, 5, 0, 3, 1), InvalidInput);
  EXPECT_THROW(crop(image, -1, 0, 3, 1), InvalidInput);
  EXPECT_THROW(crop(image, 0, 0, 0, 1), InvalidInput);
  EXPECT_THROW(middle_part(image, 0), InvalidInput);
  EXPECT_THROW(middle_part(GreyImage{}, 4), InvalidInput);
}

}  // namespace
}  // namespace papilla
