// SPDX-License-Identifier: MIT
#include "papilla/io/decode_grey16.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "io/png_fixtures.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using test::as_bytes;

TEST(DecodeGrey16, KeepsSixteenBitsInTheirByteOrder) {
  const Grey16 grey = decode_grey16(as_bytes(test::k_grey16_png), "g");
  EXPECT_EQ(grey.width, 2);
  EXPECT_EQ(grey.height, 2);
  EXPECT_EQ(grey.bits, 16);
  EXPECT_EQ(grey.values, (std::vector<std::uint16_t>{0x0102, 0xfffe, 0x0000, 0x8000}));
}

TEST(DecodeGrey16, WidensEightBits) {
  const Grey16 grey = decode_grey16(as_bytes(test::k_grey8_png), "g");
  EXPECT_EQ(grey.bits, 8);
  EXPECT_EQ(grey.values, (std::vector<std::uint16_t>{0x0101, 0xffff}));
}

TEST(DecodeGrey16, TakesTheRedChannel) {
  EXPECT_EQ(decode_grey16(as_bytes(test::k_rgb16_png), "g").values, (std::vector<std::uint16_t>{0x1234}));
}

TEST(DecodeRgb16, KeepsItsChannels) {
  const Rgb16 rgb = decode_rgb16(as_bytes(test::k_rgb16_png), "g");
  EXPECT_EQ(rgb.bits, 16);
  ASSERT_EQ(rgb.values.size(), 1U);
  EXPECT_EQ(rgb.values[0][0], decode_grey16(as_bytes(test::k_rgb16_png), "g").values[0]);
  EXPECT_EQ(rgb.values[0], (std::array<std::uint16_t, 3>{0x1234, 0x5678, 0x9abc}));
}

TEST(DecodeRgb16, GreyIsEveryChannel) {
  const Rgb16 rgb = decode_rgb16(as_bytes(test::k_grey8_png), "g");
  EXPECT_EQ(rgb.bits, 8);
  using Texel = std::array<std::uint16_t, 3>;
  EXPECT_EQ(rgb.values, (std::vector<Texel>{{0x0101, 0x0101, 0x0101}, {0xffff, 0xffff, 0xffff}}));
  EXPECT_EQ(decode_rgb16(as_bytes(test::k_grey8_alpha_png), "g").values, rgb.values) << "transparency is no colour";
  EXPECT_THROW(decode_rgb16({}, "g"), InvalidInput);
}

TEST(DecodeGrey16, RefusesWhatIsNoPng) {
  EXPECT_THROW(decode_grey16({}, "g"), InvalidInput);
  const std::vector<std::byte> zeros(100);
  EXPECT_THROW(decode_grey16(zeros, "g"), InvalidInput);
}

TEST(DecodeGrey16, RefusesTruncatedPixels) {
  const auto whole = as_bytes(test::k_grey16_png);
  const std::size_t pixels_end = whole.size() - 12 - 4;  // Before the checksum of IDAT and all of IEND.
  for (std::size_t length = 0; length < pixels_end; ++length)
    EXPECT_THROW(decode_grey16(whole.first(length), "g"), InvalidInput) << length;
}

TEST(DecodeGrey16, RefusesHugeClaimsBeforeDecoding) {
  auto bytes = std::vector<std::byte>(as_bytes(test::k_grey16_png).begin(), as_bytes(test::k_grey16_png).end());
  bytes[16] = bytes[20] = std::byte{0x7f};
  EXPECT_THROW(decode_grey16(bytes, "g"), InvalidInput);
}

TEST(DecodeGrey16, RefusesChunksThatAnnounceMoreThanThereIs) {
  auto bytes = std::vector<std::byte>(as_bytes(test::k_grey16_png).begin(), as_bytes(test::k_grey16_png).end());
  bytes[33] = std::byte{0x49};  // The length of the chunk after IHDR: 1.2 GB, which were allocated.
  EXPECT_THROW(decode_grey16(bytes, "g"), InvalidInput);
}

}  // namespace
}  // namespace papilla
