// SPDX-License-Identifier: MIT
#include "papilla/io/image_bands.hpp"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/image_file.hpp"

namespace papilla {
namespace {

using test::TemporaryFolder;

GreyImage ramp(int width, int height) {
  GreyImage image{width, height, {}, 0.1, 32};
  for (int i = 0; i < width * height; ++i) image.pixels.push_back(static_cast<float>((i * 7919) % 1009) / 1009.0F);
  return image;
}

void write_tiled(const std::filesystem::path& path, const GreyImage& image) {
  OIIO::ImageSpec spec(image.width, image.height, 1, OIIO::TypeDesc::FLOAT);
  spec.tile_width = 32;
  spec.tile_height = 16;
  const auto output = OIIO::ImageOutput::create(path.string());
  ASSERT_TRUE(output && output->open(path.string(), spec));
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, image.pixels.data()));
  ASSERT_TRUE(output->close());
}

TEST(ImageBands, BandsTogetherAreThePicture) {
  const TemporaryFolder folder;
  const GreyImage image = ramp(70, 201);
  write_grey_image(folder / "a.png", image, 16);
  write_grey_image(folder / "a.exr", image, 32);
  write_grey_image(folder / "a.tif", image, 8);
  write_tiled(folder / "tiled.tif", image);
  write_tiled(folder / "tiled.exr", image);
  for (const char* name : {"a.png", "a.exr", "a.tif", "tiled.tif", "tiled.exr"})
    for (const int rows : {1, 17, 64, 500}) {
      const GreyImage whole = read_grey_image(folder / name);
      ImageBands bands(folder / name);
      ASSERT_EQ(bands.width(), whole.width);
      ASSERT_EQ(bands.height(), whole.height);
      EXPECT_EQ(bands.bits(), whole.bits);
      EXPECT_EQ(bands.pitch_mm(), whole.pitch_mm);
      Values<float> pixels;
      for (GreyImage band = bands.next(rows); band.height > 0; band = bands.next(rows)) {
        EXPECT_LE(band.height, rows);
        pixels.insert(pixels.end(), band.pixels.begin(), band.pixels.end());
      }
      EXPECT_EQ(pixels, whole.pixels) << name << ", " << rows << " rows";
    }
}

TEST(ImageBands, SampleIsEveryPixelOfASmallPicture) {
  const TemporaryFolder folder;
  const ColorImage image{2, 2, {255, 0, 0, 0, 255, 0, 1, 2, 3, 4, 5, 6}};
  write_color_image(folder / "a.png", image);
  ImageBands bands(folder / "a.png");
  bands.next(2);
  EXPECT_EQ(bands.sample().width, 2);
  EXPECT_EQ(bands.sample().pixels, image.pixels);
}

TEST(ImageBands, SampleHoldsTheMeansOfItsBlocks) {
  const TemporaryFolder folder;
  ColorImage image{5, 3, {}};  // Blocks of 2 × 2, those at the right and below smaller.
  for (int i = 0; i < 45; ++i) image.pixels.push_back(static_cast<unsigned char>(5 * i));
  write_color_image(folder / "a.png", image);
  ImageBands bands(folder / "a.png", k_max_streamed_pixels, 3);
  while (bands.next(1).height > 0) {
  }
  ASSERT_EQ(bands.sample().width, 3);
  ASSERT_EQ(bands.sample().height, 2);
  const auto at = [&](int x, int y, int c) { return 5.0 * (15 * y + 3 * x + c); };
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(bands.sample().pixels[static_cast<std::size_t>(c)],
                (at(0, 0, c) + at(1, 0, c) + at(0, 1, c) + at(1, 1, c)) / 4, 0.51);
    EXPECT_NEAR(bands.sample().pixels[static_cast<std::size_t>(6 + c)], (at(4, 0, c) + at(4, 1, c)) / 2, 0.51);
    EXPECT_NEAR(bands.sample().pixels[static_cast<std::size_t>(9 + c)], (at(0, 2, c) + at(1, 2, c)) / 2, 0.51);
  }
}

TEST(ImageBands, SampleOfALargePictureIsSmall) {
  const TemporaryFolder folder;
  write_grey_image(folder / "a.tif", ramp(3000, 20), 8);
  ImageBands bands(folder / "a.tif");
  while (bands.next(7).height > 0) {
  }
  EXPECT_EQ(bands.sample().width, 1000);
  EXPECT_EQ(bands.sample().height, 7);
  EXPECT_EQ(bands.sample().pixels.size(), 3U * 1000 * 7);
}

TEST(ImageBands, NamesTheNumberThatIsNotFinite) {
  const TemporaryFolder folder;
  GreyImage image = ramp(10, 100);
  image.at(3, 80) = std::numeric_limits<float>::quiet_NaN();
  write_grey_image(folder / "a.exr", image, 32);
  ImageBands bands(folder / "a.exr");
  bands.next(40);
  try {
    bands.next(60);
    FAIL() << "a NaN was read";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("a.exr: pixel (3, 80) is nan, not finite"), std::string::npos)
        << error.what();
  }
}

TEST(ImageBands, RefusesMorePixelsThanAllowed) {
  const TemporaryFolder folder;
  write_grey_image(folder / "a.png", ramp(20, 20), 8);
  EXPECT_THROW(ImageBands(folder / "a.png", 399), InvalidInput);
  EXPECT_NO_THROW(ImageBands(folder / "a.png", 400));
}

}  // namespace
}  // namespace papilla
