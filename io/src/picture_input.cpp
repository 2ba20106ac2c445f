// SPDX-License-Identifier: MIT
#include "picture_input.hpp"

#include <OpenImageIO/filesystem.h>
#include <fmt/core.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>

#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/units.hpp"
#include "papilla/io/image_file.hpp"
#include "text_scanner.hpp"

namespace papilla::io_detail {
namespace {

namespace fs = std::filesystem;
using OIIO::ImageInput;
using OIIO::ImageSpec;

/// No compression that is read here stores more than this many pixels in a byte: deflate packs 1032 bytes
/// into one, and a byte holds at most 8 pixels. A file that claims more is damaged or hostile.
constexpr std::size_t k_max_pixels_per_byte = 8 * 1032;
constexpr std::size_t k_free_pixels = 65536;

/// Up to that many next bytes of a file; fewer only at its end.
using ByteSource = std::function<std::string_view(std::size_t)>;

std::uint32_t big_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (const char c : bytes.substr(0, 4)) value = value << 8 | static_cast<unsigned char>(c);
  return value;
}

/// True when the file is a PNG whose rows come in several passes, so that its reader holds the whole picture.
bool check_png_from(const ByteSource& next, const fs::path& path) {
  constexpr std::size_t k_block = 65536, k_interlace = 12;
  if (next(8) != "\x89PNG\r\n\x1a\n") return false;
  const auto taken = [&](std::size_t count) {
    const std::string_view bytes = next(count);
    if (bytes.size() < count) throw InvalidInput(path.string() + ": is truncated");
    return bytes;
  };
  for (bool interlaced = false;;) {
    std::size_t rest = big_endian(taken(4));
    const std::string name(taken(4));
    const auto crc_of = [](uLong crc, std::string_view bytes) {
      return crc32_z(crc, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    };
    uLong crc = crc_of(0, name);
    for (bool first = true; rest > 0; first = false) {
      const std::string_view bytes = taken(std::min(rest, k_block));
      if (first && name == "IHDR" && bytes.size() > k_interlace) interlaced = bytes[k_interlace] != 0;
      crc = crc_of(crc, bytes);
      rest -= bytes.size();
    }
    if (crc != big_endian(taken(4)))
      throw InvalidInput(fmt::format("{}: is damaged in chunk {}", path.string(), printable(name)));
    if (name == "IEND") return interlaced;
  }
}

/// OpenImageIO 2.4.7 reads behind its buffers where the compression of a BMP does not fit its bits a pixel.
/// Header: BITMAPFILEHEADER of 14 bytes, size of the next one, and from 40 bytes on bits a pixel and compression.
void check_bmp(const fs::path& path) {
  constexpr std::size_t k_header = 34;
  std::array<char, k_header> head{};
  std::ifstream file(path, std::ios::binary);
  if (!file.read(head.data(), k_header) || head[0] != 'B' || head[1] != 'M') return;
  const auto little_endian = [&](std::size_t at, std::size_t bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = bytes; i-- > 0;) value = value << 8 | static_cast<unsigned char>(head[at + i]);
    return value;
  };
  constexpr std::uint32_t k_rle8 = 1, k_rle4 = 2;
  const std::uint32_t bits = little_endian(28, 2), compression = little_endian(30, 4);
  if (little_endian(14, 4) < 40) return;
  if ((compression == k_rle8 && bits != 8) || (compression == k_rle4 && bits != 4))
    throw InvalidInput(fmt::format("{}: is a BMP of {} bits a pixel with compression {}, which do not fit",
                                   path.string(), bits, compression));
}

bool check_png_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError(path.string() + ": cannot be read");
  std::string block;
  return check_png_from(
      [&](std::size_t count) {
        block.resize(count);
        file.read(block.data(), static_cast<std::streamsize>(count));
        return std::string_view(block).substr(0, static_cast<std::size_t>(file.gcount()));
      },
      path);
}

}  // namespace

std::size_t pixel_count(int width, int height) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

int color_channels(const ImageSpec& spec) { return spec.nchannels >= 3 ? 3 : 1; }

ImageSpec stored_values() {
  ImageSpec wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);
  return wishes;
}

double pitch_of(const ImageSpec& spec) {
  const double x = double{spec.get_float_attribute("XResolution")},
               y = double{spec.get_float_attribute("YResolution", static_cast<float>(x))};
  const std::string unit(spec.get_string_attribute("ResolutionUnit"));
  const double length_mm = unit == "in" || unit == "inch" ? k_mm_per_inch : unit == "cm" ? 10 : unit == "m" ? 1000 : 0;
  if (!(x > 0) || !std::isfinite(x) || !(std::abs(x - y) <= 1e-3 * x)) return 0;
  return length_mm / x;
}

void check_png(std::string_view bytes, const fs::path& path) {
  check_png_from(
      [&](std::size_t count) {
        const std::string_view taken = bytes.substr(0, count);
        bytes.remove_prefix(taken.size());
        return taken;
      },
      path);
}

void check_size(const ImageSpec& spec, const fs::path& path, std::uintmax_t bytes, std::size_t most_pixels) {
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 || spec.deep)
    throw InvalidInput(path.string() + ": is no flat picture");
  const std::size_t pixels = pixel_count(spec.width, spec.height);
  const std::size_t holdable = k_free_pixels + k_max_pixels_per_byte * bytes;
  if (pixels > std::min(most_pixels, holdable))
    throw InvalidInput(fmt::format("{}: claims {} x {} pixels; at most {} are supported for its size", path.string(),
                                   spec.width, spec.height, std::min(most_pixels, holdable)));
}

std::unique_ptr<ImageInput> open_picture(const fs::path& path, std::size_t most_pixels) {
  require_file(path);
  const std::uintmax_t bytes = fs::file_size(path);
  if (bytes == 0) throw InvalidInput(path.string() + ": is empty");
  const bool interlaced = check_png_file(path);
  check_bmp(path);
  const ImageSpec wishes = stored_values();
  auto input = ImageInput::open(path.string(), &wishes);
  if (!input) throw InvalidInput(path.string() + ": is no picture: " + first_line(OIIO::geterror()));
  const bool held_whole = interlaced || std::string_view(input->format_name()) == "jpeg";
  check_size(input->spec(), path, bytes, held_whole ? std::min(most_pixels, k_max_image_pixels) : most_pixels);
  return input;
}

}  // namespace papilla::io_detail
