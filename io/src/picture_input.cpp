// SPDX-License-Identifier: MIT
#include "picture_input.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <new>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/units.hpp"
#include "papilla/io/picture_memory.hpp"
#include "picture_bytes.hpp"
#include "profile_curve.hpp"

namespace papilla::io_detail {
namespace {

namespace fs = std::filesystem;

/// No compression that is read here stores more than this many pixels in a byte: deflate packs 1032 bytes
/// into one, and a byte holds at most 8 pixels. A file that claims more is damaged or hostile.
constexpr std::size_t k_max_pixels_per_byte = 8 * 1032;
constexpr std::size_t k_free_pixels = 65536;

double megabytes(std::uint64_t bytes) { return static_cast<double>(bytes) / 1e6; }

ByteSource source_of(std::ifstream& file) {
  return [&file, block = std::string()](std::size_t count) mutable {
    block.resize(count);
    file.read(block.data(), static_cast<std::streamsize>(count));
    return std::string_view(block).substr(0, static_cast<std::size_t>(file.gcount()));
  };
}

PictureFormat checked_format(std::string_view first, const ByteSource& next, const fs::path& path) {
  PictureFormat format = picture_format(first, path);
  if (format.name.empty())
    throw InvalidInput(path.string() +
                       ": is no picture, or of a format that is not read (PNG, JPEG, TIFF, OpenEXR, PNM, PFM, HDR, "
                       "BMP, GIF, WebP, DPX, PSD and TGA are)");
  const auto [width, height] = announced_size(format.name, first);
  constexpr std::uint64_t k_rgba = 4;
  if (k_rgba * width * height > picture_memory())
    throw InvalidInput(
        fmt::format("{}: {} x {} pixels take {:.1f} MB of memory, more than the {:.1f} MB that "
                    "--max-memory allows",
                    path.string(), width, height, megabytes(k_rgba * width * height), megabytes(picture_memory())));
  if (format.name == "bmp") check_bmp(first, path);
  if (format.name == "png") format.in_rows = !check_png(next, path);
  if (format.name == "jpeg") format.in_rows = !check_jpeg(next, path);
  return format;
}

PictureFormat checked_format(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError(path.string() + ": cannot be read");
  std::string first(k_first_bytes, '\0');
  file.read(first.data(), static_cast<std::streamsize>(first.size()));
  first.resize(static_cast<std::size_t>(file.gcount()));
  file.clear();
  file.seekg(0);
  return checked_format(first, source_of(file), path);
}

/// Opens with the reader of one format. Readers that hold whole pictures look at the size that is announced before they
/// take memory.
std::unique_ptr<PictureDecoder> open_decoder(const PictureFormat& format, const std::string& name,
                                             std::optional<std::span<const std::byte>> bytes) {
  constexpr std::uint64_t k_most = 1U << 30U;
  const std::uint64_t most = std::clamp<std::uint64_t>(picture_memory() >> 20U, 1, k_most);
  const PicturesPlugin& plugin = pictures_plugin();
  std::string reason;
  try {
    if (auto decoder = plugin.open(format.name, name, bytes, format.in_rows ? 0 : static_cast<int>(most), reason))
      return decoder;
  } catch (const std::bad_alloc&) {
    throw InvalidInput(name + ": no memory is left to open it");
  } catch (const std::length_error&) {
    throw InvalidInput(name + ": announces more than its reader can hold");
  }
  if (reason.find("limits:imagesize_MB") != std::string::npos)
    throw InvalidInput(fmt::format("{}: takes more than the {:.1f} MB of memory that --max-memory allows", name,
                                   megabytes(picture_memory())));
  throw InvalidInput(fmt::format("{}: is no picture: {}", name, first_line(reason)));
}

/// Pixels of the tiles that cover `rows` rows, whole ones, or of the rows themselves.
std::size_t stored_pixels(const StoredPicture& stored, int rows) {
  const auto whole = [](int side, int tile) {
    return tile > 0 ? (static_cast<std::size_t>(side) + static_cast<std::size_t>(tile) - 1) /
                          static_cast<std::size_t>(tile) * static_cast<std::size_t>(tile)
                    : static_cast<std::size_t>(side);
  };
  return whole(stored.width, stored.tile_width) * whole(rows, stored.tile_height);
}

/// What the library that decodes holds of a picture while it is read.
std::uint64_t held_bytes(const PictureFormat& format, const StoredPicture& stored) {
  const std::uint64_t pixels = pixel_count(stored.width, stored.height);
  const auto channels = static_cast<std::uint64_t>(stored.channels);
  const auto bytes = static_cast<std::uint64_t>(stored.sample_bytes);
  if (format.name == "jpeg" && !format.in_rows) return pixels * channels * sizeof(std::int16_t);
  // libtiff turns what is neither grey, RGB, a palette nor CMYK into RGBA as a whole.
  constexpr int k_cmyk = 5;
  if (format.name == "tiff" && stored.photometric > k_cmyk) return 4 * pixels;
  if (!format.in_rows) return pixels * channels * bytes;
  return stored_pixels(stored, 1) * channels * bytes;
}

}  // namespace

std::size_t pixel_count(int width, int height) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

PictureInput::PictureInput(const fs::path& path, std::size_t most_pixels) : name_(path.string()) {
  require_file(path);
  const std::uintmax_t bytes = fs::file_size(path);
  if (bytes == 0) throw InvalidInput(name_ + ": is empty");
  const PictureFormat format = checked_format(path);
  decoder_ = open_decoder(format, name_, std::nullopt);
  check_size(bytes, most_pixels);
  held_bytes_ = held_bytes(format, stored());
}

PictureInput::PictureInput(std::span<const std::byte> bytes, const std::string& name, std::size_t most_pixels)
    : name_(name) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const PictureFormat format = checked_format(text.substr(0, k_first_bytes), source_of(text), name);
  if (format.name != "png" && format.name != "jpeg") throw InvalidInput(name + ": is neither PNG nor JPEG");
  decoder_ = open_decoder(format, name_, bytes);
  check_size(bytes.size(), most_pixels);
  held_bytes_ = held_bytes(format, stored());
}

double PictureInput::pitch_mm() const noexcept {
  const double x = double{stored().x_resolution}, y = double{stored().y_resolution};
  const std::string& unit = stored().resolution_unit;
  const double length_mm = unit == "in" || unit == "inch" ? k_mm_per_inch : unit == "cm" ? 10 : unit == "m" ? 1000 : 0;
  if (!(x > 0) || !std::isfinite(x) || !(std::abs(x - y) <= 1e-3 * x)) return 0;
  return length_mm / x;
}

std::vector<float> PictureInput::curve() const {
  if (stored().profile.empty()) return {};
  return profile_curve(stored().profile, channels());
}

void PictureInput::check_size(std::uintmax_t bytes, std::size_t most_pixels) const {
  const StoredPicture& s = stored();
  if (s.width < 1 || s.height < 1 || s.depth > 1 || s.channels < 1 || s.is_deep)
    throw InvalidInput(name_ + ": is no flat picture");
  const std::size_t most = std::min<std::size_t>(most_pixels, k_free_pixels + k_max_pixels_per_byte * bytes);
  if (stored_pixels(s, s.height) <= most) return;
  const std::string tiles = s.tile_height > 0 ? fmt::format(" in tiles of {} x {}", s.tile_width, s.tile_height) : "";
  throw InvalidInput(fmt::format("{}: claims {} x {} pixels{}; at most {} are supported for its size", name_, s.width,
                                 s.height, tiles, most));
}

void PictureInput::require_memory(std::uint64_t bytes) const {
  const std::uint64_t most = picture_memory(), needed = bytes + held_bytes_;
  if (needed > most)
    throw InvalidInput(
        fmt::format("{}: {} x {} pixels of {} channels take {:.1f} MB of memory, more than the {:.1f} MB "
                    "that --max-memory allows",
                    name_, width(), height(), stored().channels, megabytes(needed), megabytes(most)));
}

void PictureInput::read(int top, int rows, int channels, SampleType type, std::size_t sample_bytes, void* values) {
  // OpenImageIO decompresses the strips of a TIFF itself when it is asked for several rows, and takes what it can't
  // decompress for black; row by row libtiff does it, and says so.
  const bool row_by_row = stored().tile_height == 0 && stored().format == "tiff";
  const std::size_t row_bytes = pixel_count(width(), channels) * sample_bytes;
  const int step = row_by_row ? 1 : rows;
  for (int row = 0; row < rows; row += step) {
    try {
      if (decoder_->read(top + row, step, channels, type,
                         static_cast<unsigned char*>(values) + static_cast<std::size_t>(row) * row_bytes))
        continue;
    } catch (const std::bad_alloc&) {
      throw InvalidInput(
          fmt::format("{}: no memory is left at row {} of {} x {} pixels", name_, top + row, width(), height()));
    } catch (const std::length_error&) {
      throw InvalidInput(fmt::format("{}: {} x {} pixels are more than its reader can hold", name_, width(), height()));
    }
    std::string reason = first_line(decoder_->error());
    if (reason.empty()) reason = "its data end or make no sense there";
    throw InvalidInput(fmt::format("{}: is damaged at row {}: {}", name_, top + row, reason));
  }
}

void PictureInput::read(int top, int rows, float* values) {
  read(top, rows, channels(), SampleType::real, sizeof *values, values);
}

void PictureInput::read(int top, int rows, unsigned char* values) {
  read(top, rows, channels(), SampleType::byte, sizeof *values, values);
}

void PictureInput::read_stored(unsigned char* values) {
  read(0, height(), stored_channels(), SampleType::byte, sizeof *values, values);
}

}  // namespace papilla::io_detail
