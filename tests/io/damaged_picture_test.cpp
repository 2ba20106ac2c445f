// SPDX-License-Identifier: MIT
// Pictures that are damaged, or announce more than they hold: one line, and nothing from the libraries below.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/image_bands.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/io/picture_memory.hpp"
#include "picture_bytes.hpp"

namespace papilla {
namespace {

using namespace std::string_literals;
using test::TemporaryFolder;

GreyImage ramp(int width, int height) {
  GreyImage image{width, height, {}, 0, 8};
  for (std::int64_t i = 0; i < std::int64_t{width} * height; ++i)
    image.pixels.push_back(static_cast<float>((i * 7919) % 251) / 250.0F);
  return image;
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The message about a picture that is refused, alike as grey and as colour; what else is printed counts, too.
std::string refusal(const std::filesystem::path& path) {
  testing::internal::CaptureStderr();
  std::string message;
  try {
    read_grey_image(path);
    message = "read as grey";
  } catch (const Error& error) {
    message = error.what();
  }
  std::string second;
  try {
    read_color_image(path);
    second = "read as colour";
  } catch (const Error& error) {
    second = error.what();
  }
  EXPECT_EQ(message, second);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  const std::size_t folder = message.find(path.filename().string());
  return folder == std::string::npos ? message : message.substr(folder);
}

std::string chunk(const std::string& name, const std::string& data) {
  const auto big_endian = [](std::uint32_t v) {
    return std::string{static_cast<char>(v >> 24U), static_cast<char>(v >> 16U), static_cast<char>(v >> 8U),
                       static_cast<char>(v)};
  };
  std::uint32_t crc = 0xffffffffU;
  for (const char c : name + data) {
    crc ^= static_cast<unsigned char>(c);
    for (int k = 0; k < 8; ++k) crc = (crc & 1U) != 0 ? 0xedb88320U ^ crc >> 1U : crc >> 1U;
  }
  return big_endian(static_cast<std::uint32_t>(data.size())) + name + data + big_endian(~crc);
}

/// A grey PNG of 8 bits whose checksums are right, whatever its rows are.
std::string png(std::uint32_t side, const std::string& rows, char interlaced = 0, const std::string& between = "") {
  const std::string length{'\0', '\0', static_cast<char>(side >> 8U), static_cast<char>(side)};
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", length + length + "\x08\0\0\0"s + interlaced) + between +
         chunk("IDAT", rows) + chunk("IEND", "");
}

/// A zlib stream of stored bytes.
std::string stored(const std::string& bytes) {
  std::uint32_t a = 1, b = 0;
  for (const char c : bytes) b = (b + (a = (a + static_cast<unsigned char>(c)) % 65521)) % 65521;
  const auto size = static_cast<std::uint16_t>(bytes.size());
  return "\x78\x01\x01"s + static_cast<char>(size) + static_cast<char>(size >> 8U) + static_cast<char>(~size) +
         static_cast<char>(static_cast<std::uint16_t>(~size) >> 8U) + bytes + static_cast<char>(b >> 8U) +
         static_cast<char>(b) + static_cast<char>(a >> 8U) + static_cast<char>(a);
}

TEST(DamagedPicture, PngWithRightChecksumsAndWrongRows) {
  const TemporaryFolder folder;
  const std::string two_rows("\0\x10\x20\0\x30\x40", 6), good = stored(two_rows);
  EXPECT_EQ(read_grey_image(folder.write("good.png", png(2, good))).pixels[3], 64 / 255.0F);
  EXPECT_EQ(read_grey_image(folder.write("more.png", png(2, stored(two_rows + "more")))).pixels[3], 64 / 255.0F);
  EXPECT_EQ(refusal(folder.write("short.png", png(2, stored(two_rows.substr(0, 4))))),
            "short.png: is damaged in row 1: it ends there");
  EXPECT_EQ(refusal(folder.write("filter.png", png(2, stored("\0\x10\x20\x09\x30\x40"s)))),
            "filter.png: is damaged in row 1: filter 9");
  EXPECT_EQ(refusal(folder.write("sum.png", png(2, good.substr(0, good.size() - 1) + "x"))),
            "sum.png: is damaged after its last row: incorrect data check");
  EXPECT_EQ(refusal(folder.write("none.png", png(2, "no zlib stream"))),
            "none.png: is damaged in row 0: incorrect header check");
  EXPECT_EQ(refusal(folder.write("critical.png", png(2, good, 0, chunk("ABCD", "")))),
            "critical.png: has an unknown critical chunk ABCD");
  std::string crc = png(2, good);
  crc[crc.size() - 13] ^= 1;
  EXPECT_EQ(refusal(folder.write("crc.png", crc)), "crc.png: is damaged in chunk IDAT");
}

TEST(DamagedPicture, PngOfSevenPassesIsReadWhole) {
  const TemporaryFolder folder;
  // Passes 1, 6 and 7 of a picture of 2 x 2: (0, 0); (1, 0); (0, 1) and (1, 1).
  const std::string rows("\0\x10\0\x20\0\x30\x40", 7);
  const GreyImage image = read_grey_image(folder.write("a.png", png(2, stored(rows), 1)));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_FLOAT_EQ(image.pixels[i], static_cast<float>(16 * (i + 1)) / 255.0F);
  EXPECT_EQ(refusal(folder.write("b.png", png(2, stored(rows.substr(0, 6)), 1))),
            "b.png: is damaged in row 0: it ends there");
}

TEST(DamagedPicture, TiffStripThatCannotBeDecompressed) {
  const TemporaryFolder folder;
  write_grey_image(folder / "a.tif", ramp(300, 400), 8);
  std::string bytes = bytes_of(folder / "a.tif");
  const std::string tag("\x11\x01\x04\0", 4);  // StripOffsets, LONG; then their number, and where they or the one is.
  const auto number = [&](std::size_t at) {
    std::size_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = value << 8U | static_cast<unsigned char>(bytes.at(at + i));
    return value;
  };
  const std::size_t at = bytes.find(tag);
  ASSERT_NE(at, std::string::npos);
  const std::size_t strip = number(at + 4) == 1 ? number(at + 8) : number(number(at + 8));
  bytes.at(strip) = bytes.at(strip + 1) = '\xff';
  const std::string message = refusal(folder.write("strip.tif", bytes));
  EXPECT_TRUE(message.starts_with("strip.tif: is damaged at row 0: ")) << message;
}

TEST(DamagedPicture, TiffOfAnUnknownCompression) {
  const TemporaryFolder folder;
  write_grey_image(folder / "a.tif", ramp(30, 40), 8);
  std::string bytes = bytes_of(folder / "a.tif");
  const std::string tag("\x03\x01\x03\0\x01\0\0\0", 8);  // Compression, SHORT, one value.
  const std::size_t at = bytes.find(tag);
  ASSERT_NE(at, std::string::npos);
  bytes[at + 8] = 0x39, bytes[at + 9] = 0x30;
  const std::string message = refusal(folder.write("scheme.tif", bytes));
  EXPECT_NE(message.find("12345"), std::string::npos) << message;
}

TEST(DamagedPicture, JpegThatEndsEarlyOrHasTooManyScans) {
  const TemporaryFolder folder;
  write_color_image(folder / "a.jpg", {64, 64, Values<unsigned char>(3 * 64 * 64, 99)});
  const std::string bytes = bytes_of(folder / "a.jpg");
  EXPECT_EQ(refusal(folder.write("half.jpg", bytes.substr(0, bytes.size() / 2))), "half.jpg: is truncated");
  EXPECT_EQ(refusal(folder.write("end.jpg", bytes.substr(0, bytes.size() - 2))), "end.jpg: is truncated");
  std::string scans = "\xff\xd8";
  for (int i = 0; i < 501; ++i) scans += "\xff\xda\0\x02"s;
  EXPECT_EQ(refusal(folder.write("scans.jpg", scans + "\xff\xd9")),
            "scans.jpg: has more than 500 scans, each a pass over the picture");
}

TEST(DamagedPicture, FloatsBeyondAMillionAreNamed) {
  const TemporaryFolder folder;
  GreyImage image = ramp(10, 90);
  image.at(7, 80) = 3e38F;
  write_grey_image(folder / "a.exr", image, 32);
  EXPECT_EQ(refusal(folder / "a.exr"), "a.exr: pixel (7, 80) is 3e+38, beyond a million");
  image.at(7, 80) = -1e6F;
  write_grey_image(folder / "b.exr", image, 32);
  EXPECT_EQ(read_grey_image(folder / "b.exr").at(7, 80), -1e6F);
}

TEST(DamagedPicture, TilesFarLargerThanThePicture) {
  const TemporaryFolder folder;
  OIIO::ImageSpec spec(4, 4, 1, OIIO::TypeDesc::HALF);
  spec.tile_width = spec.tile_height = 4;
  const auto out = OIIO::ImageOutput::create("exr");
  ASSERT_TRUE(out->open((folder / "tiles.exr").string(), spec));
  const std::vector<float> tile(16);
  ASSERT_TRUE(out->write_tile(0, 0, 0, OIIO::TypeDesc::FLOAT, tile.data()));
  ASSERT_TRUE(out->close());
  std::string bytes = bytes_of(folder / "tiles.exr");
  const std::string place = "tiledesc\0\x09\0\0\0"s;  // Its width and height follow, the low byte first.
  const std::size_t at = bytes.find(place);
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(read_grey_image(folder / "tiles.exr").width, 4);
  bytes.replace(at + place.size(), 8, "\0\x20\0\0\0\x20\0\0"s);
  const std::string message = refusal(folder.write("huge.exr", bytes));
  EXPECT_NE(message.find("huge.exr: claims 4 x 4 pixels in tiles of 8192 x 8192;"), std::string::npos) << message;
}

TEST(DamagedPicture, FormatsThatAreDecodedBeforeTheirSizeIsKnownAreNotRead) {
  const TemporaryFolder folder;
  EXPECT_NE(refusal(folder.write("a.jp2", "\0\0\0\x0cjP  \r\n\x87\n"s)).find("of a format that is not read"),
            std::string::npos);
}

/// A segment of a JPEG.
std::string segment(unsigned char marker, const std::string& content) {
  const std::size_t length = content.size() + 2;
  return "\xff"s + static_cast<char>(marker) + static_cast<char>(length >> 8U) + static_cast<char>(length) + content;
}

/// SOF of 512 x 512 pixels, unsubsampled.
std::string frame(unsigned char marker, int components) {
  std::string content = "\x08\x02\0\x02\0"s + static_cast<char>(components);
  for (int c = 1; c <= components; ++c) content += static_cast<char>(c) + "\x11\0"s;
  return segment(marker, content);
}

/// SOS of the first components; `last` is the last coefficient.
std::string scan(int components, int last) {
  std::string content(1, static_cast<char>(components));
  for (int c = 1; c <= components; ++c) content += static_cast<char>(c) + "\0"s;
  return segment(0xda, content + "\0"s + static_cast<char>(last) + "\0"s);
}

TEST(JpegScans, AnyButOneOfAllComponentsIsHeldWhole) {
  const auto held_whole = [](const std::string& segments) {
    const std::string bytes = "\xff\xd8" + segments + "\xff\xd9";
    return io_detail::check_jpeg(io_detail::source_of(bytes), "a.jpg");
  };
  EXPECT_FALSE(held_whole(frame(0xc0, 1) + scan(1, 63)));
  EXPECT_FALSE(held_whole(frame(0xc1, 3) + scan(3, 63)));
  EXPECT_TRUE(held_whole(frame(0xc2, 1) + scan(1, 0))) << "progressive";
  EXPECT_TRUE(held_whole(frame(0xca, 3) + scan(3, 0))) << "progressive, arithmetic";
  EXPECT_TRUE(held_whole(frame(0xc0, 3) + scan(1, 63))) << "one component of three";
  EXPECT_TRUE(held_whole(frame(0xc0, 1) + scan(1, 63) + scan(1, 63)));
  EXPECT_FALSE(held_whole(segment(0xc4, "\xc2\0"s) + segment(0xcc, "\0"s) + frame(0xc0, 1) + scan(1, 63)));
  EXPECT_FALSE(held_whole(segment(0xc2, "") + segment(0xda, ""))) << "too short to say";
}

/// Sets picture_memory() as long as it lives.
class Budget {
 public:
  explicit Budget(std::uint64_t bytes) { set_picture_memory(bytes); }
  ~Budget() { set_picture_memory(0); }
  Budget(const Budget&) = delete;
  Budget& operator=(const Budget&) = delete;
};

TEST(PictureMemory, IsHalfOfTheMachinesAtMost) {
  EXPECT_GT(picture_memory(), 1U << 20U);
  const Budget budget(5000);
  EXPECT_EQ(picture_memory(), 5000U);
}

TEST(PictureMemory, RefusesBeforeDecoding) {
  const TemporaryFolder folder;
  write_grey_image(folder / "a.tif", ramp(2000, 1000), 8);
  const Budget budget(4'000'000);
  EXPECT_EQ(refusal(folder / "a.tif").substr(0, 34), "a.tif: 2000 x 1000 pixels of 1 cha");
  EXPECT_NE(refusal(folder / "a.tif").find("8.0 MB of memory, more than the 4.0 MB that --max-memory allows"),
            std::string::npos);
  ImageBands bands(folder / "a.tif");
  EXPECT_EQ(bands.next(100).height, 100) << "in bands it is within the budget";
}

TEST(PictureMemory, CountsWhatAReaderHolds) {
  const TemporaryFolder folder;
  const std::string rows = stored(std::string(300 * 301 * 2, '\0').substr(0, 65535));
  const std::string seven_passes = png(300, rows, 1);
  const Budget budget(100'000);
  EXPECT_THROW(ImageBands(folder.write("a.png", seven_passes)), InvalidInput);
  // An animation that announces 65535 x 65535 in 40 bytes.
  const std::string gif =
      "GIF89a\xff\xff\xff\xff\x80\0\0\0\0\0\xff\xff\xff,\0\0\0\0\xff\xff\xff\xff\0\x02\x02\x4c\x01\0;"s;
  EXPECT_THROW(ImageBands(folder.write("a.gif", gif)), InvalidInput);
}

/// 512 x 512 pixels, of which only the constant coefficients are there, all 0.
TEST(PictureMemory, CountsAProgressiveJpegOfOneScan) {
  const TemporaryFolder folder;
  const std::string tables =
      segment(0xdb, "\0"s + std::string(64, '\1')) + segment(0xc4, "\0\1"s + std::string(15, '\0') + "\0"s);
  const std::string blocks(64 * 64 / 8, '\0');  // A bit each: the code of the difference 0.
  const auto file = folder.write("a.jpg", "\xff\xd8" + tables + frame(0xc2, 1) + scan(1, 0) + blocks + "\xff\xd9");
  EXPECT_FLOAT_EQ(read_grey_image(file).pixels.back(), 128 / 255.0F);
  // The bands take 64 rows as they are stored, as grey values and as those returned; libjpeg two bytes a coefficient.
  constexpr std::uint64_t k_bands = std::uint64_t{3} * 64 * 512 * sizeof(float), k_held = std::uint64_t{2} * 512 * 512;
  const Budget budget(k_bands + k_held / 2);
  EXPECT_THROW(ImageBands{file}, InvalidInput);
}

}  // namespace
}  // namespace papilla
