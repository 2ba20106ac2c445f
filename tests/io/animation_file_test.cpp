// SPDX-License-Identifier: MIT
#include "papilla/io/animation_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "papilla/core/error.hpp"
#include "papilla/io/image_file.hpp"
#include "temporary_folder.hpp"

namespace papilla {
namespace {

ColorImage plain(int width, int height, unsigned char red) {
  ColorImage image{width, height, {}};
  for (int k = 0; k < width * height; ++k) image.pixels.insert(image.pixels.end(), {red, 20, 200});
  return image;
}

TEST(AnimationFile, HoldsEveryPictureItsDelayAndLoops) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "a.gif";
  const std::vector<ColorImage> frames = {plain(20, 10, 250), plain(20, 10, 128), plain(20, 10, 2)};
  write_animation(path, frames, 5);
  std::ifstream in(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  EXPECT_EQ(bytes.substr(0, 6), "GIF89a");
  EXPECT_NE(bytes.find("NETSCAPE2.0"), std::string::npos) << "loops";
  // A graphic control extension a picture: 21 F9 04 flags delay delay (hundredths of a second).
  std::size_t pictures = 0;
  for (std::size_t at = 0; (at = bytes.find("\x21\xF9\x04", at)) != std::string::npos; ++at, ++pictures)
    EXPECT_EQ(static_cast<unsigned char>(bytes[at + 4]) + 256 * static_cast<unsigned char>(bytes[at + 5]), 20);
  EXPECT_EQ(pictures, 8U) << "three, the last one six times";
  const ColorImage first = read_color_image(path);
  EXPECT_EQ(first.width, 20);
  EXPECT_NEAR(first.pixels[0], 250, 8);
}

TEST(AnimationFile, RefusesUnlikePicturesAndOtherFormats) {
  const test::TemporaryFolder folder;
  const std::vector<ColorImage> unlike = {plain(4, 4, 0), plain(5, 4, 0)}, good = {plain(4, 4, 0)};
  EXPECT_THROW(write_animation(folder.path() / "a.gif", unlike, 5), InvalidInput);
  EXPECT_THROW(write_animation(folder.path() / "a.gif", {}, 5), InvalidInput);
  EXPECT_THROW(write_animation(folder.path() / "a.gif", good, 0), InvalidInput);
  EXPECT_THROW(write_animation(folder.path() / "a.mp4", good, 5), InvalidInput);
  EXPECT_THROW(write_animation(folder.path() / "none" / "a.gif", good, 5), IoError);
}

}  // namespace
}  // namespace papilla
