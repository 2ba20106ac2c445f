// SPDX-License-Identifier: MIT
#include "papilla/io/image_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "io/png_fixtures.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/decode_grey16.hpp"

namespace papilla {
namespace {

using test::TemporaryFolder;

std::string text_of(std::span<const unsigned char> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

HeightMap ramp(int width, int height) {
  HeightMap map{width, height, {}, 0.05, 0.05, false};
  for (int i = 0; i < width * height; ++i) map.mm.push_back(static_cast<float>(-0.3 + 0.001 * ((i * 7919) % 1009)));
  return map;
}

/// The names of a PNG's chunks, one after the other.
std::string chunks(const std::string& png) {
  std::string names;
  for (std::size_t at = 8; at + 8 <= png.size();) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = length << 8 | static_cast<unsigned char>(png[at + i]);
    names += png.substr(at + 4, 4) + " ";
    at += 12 + length;
  }
  return names;
}

TEST(ImageFile, ReadsSixteenBitsAsStored) {
  const TemporaryFolder folder;
  const GreyImage image = read_grey_image(folder.write("a.png", text_of(test::k_grey16_png)));
  EXPECT_EQ(image.bits, 16);
  EXPECT_EQ(image.width, 2);
  EXPECT_FLOAT_EQ(image.at(0, 0), 0x0102 / 65535.0F);
  EXPECT_FLOAT_EQ(image.at(1, 0), 0xfffe / 65535.0F);
  EXPECT_FLOAT_EQ(image.at(1, 1), 0x8000 / 65535.0F);
  EXPECT_EQ(image.pitch_mm, 0);
}

TEST(ImageFile, ColourBecomesLuminance) {
  const TemporaryFolder folder;
  write_color_image(folder / "a.png", {2, 1, {255, 0, 0, 0, 51, 255}});
  const GreyImage image = read_grey_image(folder / "a.png");
  EXPECT_EQ(image.bits, 8);
  EXPECT_NEAR(image.at(0, 0), 0.2126, 1e-6);
  EXPECT_NEAR(image.at(1, 0), 0.2 * 0.7152 + 0.0722, 1e-6);
}

TEST(ImageFile, ColourComesBack) {
  const TemporaryFolder folder;
  const ColorImage image{2, 1, {1, 2, 3, 250, 251, 252}};
  write_color_image(folder / "a.tif", image);
  EXPECT_EQ(read_color_image(folder / "a.tif").pixels, image.pixels);
  folder.write("b.png", text_of(encode_png(image)));
  EXPECT_EQ(read_color_image(folder / "b.png").pixels, image.pixels);
  EXPECT_EQ(encode_png(image), encode_png(image));
  EXPECT_EQ(read_color_image(folder.write("g.png", text_of(test::k_grey8_png))).pixels,
            (Values<unsigned char>{1, 1, 1, 255, 255, 255}));
}

TEST(ImageFile, GreyAndColourOfOneDecodingAreThoseOfTwo) {
  const TemporaryFolder folder;
  ColorImage image{1500, 3, Values<unsigned char>(3 * 1500 * 3)};
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<unsigned char>(i * 37 % 256);
  write_color_image(folder / "a.png", image);
  write_grey_image(folder / "b.png", read_grey_image(folder / "a.png"), 16);
  for (const char* name : {"a.png", "b.png"}) {
    const Picture picture = read_picture(folder / name);
    EXPECT_EQ(picture.grey.pixels, read_grey_image(folder / name).pixels) << name;
    EXPECT_EQ(picture.color.pixels, read_color_image(folder / name).pixels) << name;
    EXPECT_EQ(picture.color.width, 1500);
  }
}

TEST(ImageFile, ReducedPicturesAreMeansWithAsMuchCoarserPixels) {
  const TemporaryFolder folder;
  GreyImage image{7, 5, {}, 0.05, 16};
  for (int i = 0; i < 35; ++i) image.pixels.push_back(static_cast<float>(i * i) / 1225);
  write_grey_image(folder / "a.tif", image, 16);
  const Picture whole = read_reduced_picture(folder / "a.tif", 7);
  EXPECT_EQ(whole.grey.pixels, read_grey_image(folder / "a.tif").pixels);
  EXPECT_EQ(whole.grey.bits, 16);
  const Picture reduced = read_reduced_picture(folder / "a.tif", 3);
  ASSERT_EQ(reduced.grey.width, 3);
  ASSERT_EQ(reduced.grey.height, 2);
  EXPECT_EQ(reduced.color.width, 3);
  EXPECT_EQ(reduced.color.height, 2);
  EXPECT_NEAR(reduced.grey.pitch_mm, 0.15, 1e-5);
  double first = 0, last = 0;
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) first += static_cast<double>(image.at(x, y)) / 9;
  for (int y = 3; y < 5; ++y) last += static_cast<double>(image.at(6, y)) / 2;
  EXPECT_NEAR(reduced.grey.pixels[0], first, 2e-5);
  EXPECT_NEAR(reduced.grey.pixels[5], last, 2e-5);
}

TEST(ImageFile, GreyComesBackWithPitchInEveryDepth) {
  const TemporaryFolder folder;
  GreyImage image{3, 2, {0, 0.25F, 0.5F, 0.75F, 1, 0.125F}, 0.05, 32};
  for (const auto& [name, bits] : {std::pair{"a.png", 8}, {"a.png", 16}, {"a.tif", 8}, {"a.tif", 16}, {"a.tif", 32}}) {
    write_grey_image(folder / name, image, bits);
    const GreyImage back = read_grey_image(folder / name);
    EXPECT_EQ(back.bits, bits);
    EXPECT_NEAR(back.pitch_mm, 0.05, 1e-5) << name;
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(back.pixels[i], image.pixels[i], bits == 8 ? 0.002 : 1e-5);
  }
}

TEST(ImageFile, HeightAsFloatComesBack) {
  const TemporaryFolder folder;
  const HeightMap map = ramp(13, 7);
  for (const char* name : {"a.exr", "a.tif"}) {
    write_height_float(folder / name, map);
    const GreyImage back = read_grey_image(folder / name);
    EXPECT_EQ(back.pixels, map.mm) << name;
    EXPECT_EQ(back.bits, 32);
    EXPECT_NEAR(back.pitch_mm, 0.05, 1e-6) << name;
  }
}

TEST(ImageFile, EncodedHeightIsWithinHalfAStep) {
  const HeightMap map = ramp(40, 30);
  const EncodedHeight encoded = encode_height_png16(map);
  const Grey16 decoded = decode_grey16(encoded.png, "height");
  EXPECT_EQ(decoded.bits, 16);
  ASSERT_EQ(decoded.values.size(), map.mm.size());
  for (std::size_t i = 0; i < map.mm.size(); ++i)
    EXPECT_NEAR(encoded.offset_mm + encoded.scale_mm * decoded.values[i] / 65535, double{map.mm[i]},
                encoded.scale_mm / 131070 * (1 + 1e-9));
  EXPECT_EQ(*std::min_element(decoded.values.begin(), decoded.values.end()), 0);
  EXPECT_EQ(*std::max_element(decoded.values.begin(), decoded.values.end()), 65535) << "white is outward";
}

TEST(ImageFile, EncodedHeightHasNoColourChunks) {
  const std::string names = chunks(text_of(encode_height_png16(ramp(5, 4)).png));
  EXPECT_TRUE(names.starts_with("IHDR ") && names.ends_with("IDAT IEND ")) << names;
  for (const char* name : {"gAMA", "sRGB", "iCCP", "cHRM", "tIME", "tEXt"})
    EXPECT_EQ(names.find(name), std::string::npos) << names;
}

TEST(ImageFile, AFlatMapHasNoScale) {
  const EncodedHeight encoded = encode_height_png16({2, 1, {0.5F, 0.5F}, 1, 1, false});
  EXPECT_EQ(encoded.scale_mm, 0);
  EXPECT_EQ(encoded.offset_mm, 0.5);
}

TEST(ImageFile, RefusesWhatIsNoPicture) {
  const TemporaryFolder folder;
  EXPECT_THROW(read_grey_image(folder / "none.png"), IoError);
  EXPECT_THROW(read_grey_image(folder / ""), IoError);
  EXPECT_THROW(read_grey_image(folder.write("empty.png", "")), InvalidInput);
  EXPECT_THROW(read_color_image(folder.write("text.png", "hello, this is no picture")), InvalidInput);
  std::string huge = text_of(test::k_grey8_png);
  huge.replace(16, 8, std::string("\0\0\x7f\0\0\0\x7f\0", 8));
  EXPECT_THROW(read_grey_image(folder.write("huge.png", huge)), InvalidInput);
}

TEST(ImageFile, EveryPrefixThrowsOrSucceeds) {
  const TemporaryFolder folder;
  const std::string whole = text_of(encode_height_png16(ramp(9, 9)).png);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    try {
      EXPECT_EQ(read_grey_image(folder.write("a.png", whole.substr(0, length))).width, 9);
    } catch (const InvalidInput& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

TEST(ImageFile, RefusesWrongArguments) {
  const TemporaryFolder folder;
  const GreyImage image{1, 1, {0.5F}, 0, 32};
  EXPECT_THROW(write_grey_image(folder / "a.xyz", image, 8), InvalidInput);
  EXPECT_THROW(write_grey_image(folder / "a.png", image, 12), InvalidInput);
  EXPECT_THROW(write_grey_image(folder / "a.png", image, 32), InvalidInput);
  EXPECT_THROW(write_grey_image(folder / "a.png", GreyImage{2, 2, {0.5F}, 0, 32}, 8), InvalidInput);
  EXPECT_THROW(encode_height_png16({}), InvalidInput);
  EXPECT_THROW(encode_height_png16({1, 1, {std::nanf("")}, 1, 1, false}), InvalidInput);
  EXPECT_THROW(write_color_image(folder / "no" / "a.png", {1, 1, {1, 2, 3}}), IoError);
  EXPECT_EQ(folder.files(), 0U);
}

TEST(ImageFile, DecodesFromMemoryWhatItEncoded) {
  ColorImage image{3, 2, {}};
  for (int i = 0; i < 18; ++i) image.pixels.push_back(static_cast<unsigned char>(13 * i));
  const ColorImage back = decode_color_image(encode_png(image), "test");
  EXPECT_EQ(back.width, 3);
  EXPECT_EQ(back.height, 2);
  EXPECT_EQ(back.pixels, image.pixels);
  std::vector<std::byte> half = encode_png(image);
  half.resize(half.size() / 2);
  EXPECT_THROW(decode_color_image(half, "half"), InvalidInput);
  EXPECT_THROW(decode_color_image({}, "nothing"), InvalidInput);
}

}  // namespace
}  // namespace papilla
