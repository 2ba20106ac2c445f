// SPDX-License-Identifier: MIT
#include "picture_bytes.hpp"

#include <fmt/core.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "text_scanner.hpp"

namespace papilla::io_detail {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t k_block = 65536;

std::uint32_t big_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (const char c : bytes.substr(0, 4)) value = value << 8 | static_cast<unsigned char>(c);
  return value;
}

std::uint64_t little_endian(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = count; i-- > 0;) value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// Takes whole pieces from a source.
class Bytes {
 public:
  Bytes(const ByteSource& next, const fs::path& path) : next_(next), path_(path) {}

  std::string_view take(std::size_t count) const {
    const std::string_view bytes = next_(count);
    if (bytes.size() < count) throw InvalidInput(path_.string() + ": is truncated");
    return bytes;
  }
  [[noreturn]] void fail(const std::string& what) const { throw InvalidInput(path_.string() + ": " + what); }

 private:
  const ByteSource& next_;
  const fs::path& path_;
};

struct PngHeader {
  std::uint32_t width = 0, height = 0;
  int bits = 0, colour = 0;
  bool interlaced = false;

  std::size_t row_bytes(std::uint64_t columns) const {
    constexpr std::array<int, 7> k_channels = {1, 0, 3, 1, 2, 0, 4};
    const auto pixel_bits = static_cast<std::uint64_t>(bits * k_channels[static_cast<std::size_t>(colour)]);
    return static_cast<std::size_t>((columns * pixel_bits + 7) / 8);
  }
};

PngHeader png_header(const Bytes& bytes, std::string_view data) {
  if (data.size() != 13) bytes.fail("is damaged in chunk IHDR");
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(data[i]); };
  PngHeader header{big_endian(data), big_endian(data.substr(4)), at(8), at(9), at(12) == 1};
  constexpr std::array<unsigned, 7> k_depths = {1 | 2 | 4 | 8 | 16, 0, 8 | 16, 1 | 2 | 4 | 8, 8 | 16, 0, 8 | 16};
  const auto depth = static_cast<unsigned>(header.bits);
  const bool known = header.colour < 7 && depth > 0 && (depth & (depth - 1)) == 0 &&
                     (k_depths[static_cast<std::size_t>(header.colour)] & depth) != 0;
  constexpr std::uint32_t k_longest = 0x7fffffff;
  if (!known || header.width == 0 || header.height == 0 || header.width > k_longest || header.height > k_longest ||
      at(10) != 0 || at(11) != 0 || at(12) > 1)
    bytes.fail("is damaged in chunk IHDR");
  return header;
}

/// Decompresses the rows of a PNG and looks at the filter that each begins with.
class PngRows {
 public:
  PngRows(const Bytes& bytes, const PngHeader& header) : bytes_(bytes) {
    if (header.interlaced) {
      // First column and row, and their steps, of the seven passes of Adam7.
      constexpr std::array<std::array<unsigned, 4>, 7> k_passes = {
          {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4}, {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}}};
      for (const auto& [x, y, dx, dy] : k_passes) {
        const std::uint64_t columns = (std::uint64_t{header.width} + dx - 1 - x) / dx,
                            rows = (std::uint64_t{header.height} + dy - 1 - y) / dy;
        if (columns > 0 && rows > 0) passes_.push_back({1 + header.row_bytes(columns), rows});
      }
    } else {
      passes_.push_back({1 + header.row_bytes(header.width), header.height});
    }
    if (inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
  }
  ~PngRows() { inflateEnd(&stream_); }
  PngRows(const PngRows&) = delete;
  PngRows& operator=(const PngRows&) = delete;

  void add(std::string_view compressed) {
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data()));
    stream_.avail_in = static_cast<uInt>(compressed.size());
    while (!ended_) {
      stream_.next_out = block_.data();
      stream_.avail_out = static_cast<uInt>(block_.size());
      const int status = inflate(&stream_, Z_NO_FLUSH);
      const bool has_more = look_at(block_.size() - stream_.avail_out);
      if (!has_more && status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR)
        fail(stream_.msg ? stream_.msg : "not as zlib writes it");
      ended_ = has_more || status == Z_STREAM_END;
      if (stream_.avail_out > 0) return;  // What came in is used up.
    }
  }

  void finish() const {
    if (pass_ < passes_.size()) fail("it ends there");
    if (!ended_) fail("the checksum is missing");
  }

 private:
  struct Pass {
    std::size_t row_bytes;
    std::uint64_t rows;
  };

  [[noreturn]] void fail(const std::string& what) const {
    if (pass_ == passes_.size()) bytes_.fail("is damaged after its last row: " + what);
    bytes_.fail(fmt::format("is damaged in row {}: {}", done_, what));
  }

  /// The filters of the rows that begin within the first `count` bytes of the block. @returns whether bytes follow the
  /// last row, which nobody reads.
  bool look_at(std::size_t count) {
    constexpr int k_filters = 5;
    std::size_t at = 0;
    while (at < count && pass_ < passes_.size()) {
      const Pass& pass = passes_[pass_];
      if (in_row_ == 0 && block_[at] >= k_filters) fail(fmt::format("filter {}", block_[at]));
      const std::size_t taken = std::min(count - at, pass.row_bytes - in_row_);
      at += taken;
      in_row_ += taken;
      if (in_row_ < pass.row_bytes) break;
      in_row_ = 0;
      ++done_;
      if (++row_ < pass.rows) continue;
      row_ = done_ = 0;
      ++pass_;
    }
    return at < count;
  }

  const Bytes& bytes_;
  std::vector<Pass> passes_;
  std::size_t pass_ = 0, in_row_ = 0;
  std::uint64_t row_ = 0, done_ = 0;
  bool ended_ = false;
  z_stream stream_{};
  std::array<Bytef, k_block> block_{};
};

/// Walks over the bytes of a JPEG.
class JpegBytes {
 public:
  JpegBytes(const ByteSource& next, const fs::path& path) : next_(next), path_(path) {}

  unsigned char byte() {
    fill();
    const auto value = static_cast<unsigned char>(ahead_.front());
    ahead_.remove_prefix(1);
    return value;
  }
  void skip(std::size_t count) {
    while (count > 0) {
      fill();
      const std::size_t taken = std::min(count, ahead_.size());
      ahead_.remove_prefix(taken);
      count -= taken;
    }
  }
  /// Skips entropy-coded bytes, in which 0xff is followed by 0, up to the next marker.
  unsigned char next_marker() {
    constexpr unsigned char k_escape = 0xff;
    while (true) {
      fill();
      const std::size_t at = ahead_.find(static_cast<char>(k_escape));
      ahead_.remove_prefix(std::min(at, ahead_.size()));
      if (at == std::string_view::npos) continue;
      unsigned char marker = k_escape;
      while (marker == k_escape) marker = byte();
      if (marker != 0) return marker;
    }
  }

 private:
  void fill() {
    if (ahead_.empty()) ahead_ = next_(k_block);
    if (ahead_.empty()) throw InvalidInput(path_.string() + ": is truncated");
  }

  const ByteSource& next_;
  const fs::path& path_;
  std::string_view ahead_;
};

/// SOF0 to SOF15; the three markers between them are tables and an extension.
bool is_frame(unsigned char marker) {
  constexpr unsigned char k_huffman_tables = 0xc4, k_extension = 0xc8, k_arithmetic_tables = 0xcc;
  return marker >= 0xc0 && marker <= 0xcf && marker != k_huffman_tables && marker != k_extension &&
         marker != k_arithmetic_tables;
}

}  // namespace

ByteSource source_of(std::string_view bytes) {
  return [bytes](std::size_t count) mutable {
    const std::string_view taken = bytes.substr(0, count);
    bytes.remove_prefix(taken.size());
    return taken;
  };
}

PictureFormat picture_format(std::string_view first, const fs::path& path) {
  using namespace std::string_view_literals;
  if (first.starts_with("\x89PNG\r\n\x1a\n"sv)) return {"png", true};
  if (first.starts_with("\xff\xd8"sv)) return {"jpeg", true};
  if (first.starts_with("II*\0"sv) || first.starts_with("MM\0*"sv) || first.starts_with("II+\0"sv) ||
      first.starts_with("MM\0+"sv))
    return {"tiff", true};
  if (first.starts_with("\x76\x2f\x31\x01"sv)) return {"openexr", true};
  if (first.size() > 2 && first[0] == 'P' && "123456Ff"sv.find(first[1]) != std::string_view::npos)
    return {"pnm", true};
  if (first.starts_with("#?"sv)) return {"hdr", true};
  if (first.starts_with("BM"sv)) return {"bmp"};
  if (first.starts_with("GIF8"sv)) return {"gif"};
  if (first.starts_with("RIFF"sv) && first.substr(std::min<std::size_t>(8, first.size())).starts_with("WEBP"sv))
    return {"webp"};
  if (first.starts_with("SDPX"sv) || first.starts_with("XPDS"sv)) return {"dpx"};
  if (first.starts_with("8BPS"sv)) return {"psd"};
  if (equals_ignoring_case(path.extension().string(), ".tga")) return {"targa"};
  return {};
}

AnnouncedSize announced_size(std::string_view format, std::string_view first) {
  constexpr std::size_t k_gif = 10, k_bmp = 26, k_webp = 30;
  if (format == "gif" && first.size() >= k_gif) return {little_endian(first, 6, 2), little_endian(first, 8, 2)};
  if (format == "bmp" && first.size() >= k_bmp) {
    const auto signed_size = [&](std::size_t at) {
      return static_cast<std::uint64_t>(std::abs(std::int64_t{static_cast<std::int32_t>(little_endian(first, at, 4))}));
    };
    return {signed_size(18), signed_size(22)};
  }
  if (format != "webp" || first.size() < k_webp) return {};
  constexpr std::uint64_t k_14_bits = 0x3fff;
  if (first.substr(12, 4) == "VP8X") return {little_endian(first, 24, 3) + 1, little_endian(first, 27, 3) + 1};
  if (first.substr(12, 4) == "VP8L") {
    const std::uint64_t bits = little_endian(first, 21, 4);
    return {(bits & k_14_bits) + 1, (bits >> 14U & k_14_bits) + 1};
  }
  return {little_endian(first, 26, 2) & k_14_bits, little_endian(first, 28, 2) & k_14_bits};
}

void check_bmp(std::string_view first, const fs::path& path) {
  constexpr std::uint64_t k_with_compression = 40, k_rle8 = 1, k_rle4 = 2;
  if (first.size() < k_first_bytes || little_endian(first, 14, 4) < k_with_compression) return;
  const std::uint64_t bits = little_endian(first, 28, 2), compression = little_endian(first, 30, 4);
  if ((compression == k_rle8 && bits != 8) || (compression == k_rle4 && bits != 4))
    throw InvalidInput(fmt::format("{}: is a BMP of {} bits a pixel with compression {}, which do not fit",
                                   path.string(), bits, compression));
}

bool check_png(const ByteSource& next, const fs::path& path) {
  const Bytes bytes(next, path);
  bytes.take(8);
  PngHeader header;
  std::unique_ptr<PngRows> rows;
  for (bool palette = false;;) {
    const std::size_t length = big_endian(bytes.take(4));
    const std::string name(bytes.take(4));
    const auto crc_of = [](uLong crc, std::string_view part) {
      return crc32_z(crc, reinterpret_cast<const unsigned char*>(part.data()), part.size());
    };
    const bool is_header = name == "IHDR", is_rows = name == "IDAT";
    const auto damaged = [&] { bytes.fail("is damaged in chunk " + printable(name)); };
    if (is_header == (header.width > 0) || (is_header && length > k_block)) damaged();
    palette |= name == "PLTE";
    if (is_rows && !rows) {
      constexpr int k_indexed = 3;
      if (header.colour == k_indexed && !palette) bytes.fail("is damaged: its palette is missing");
      rows = std::make_unique<PngRows>(bytes, header);
    }
    const bool critical = (static_cast<unsigned char>(name[0]) & 0x20U) == 0;
    if (critical && !is_header && !is_rows && name != "PLTE" && name != "IEND")
      bytes.fail("has an unknown critical chunk " + printable(name));
    uLong crc = crc_of(0, name);
    for (std::size_t rest = length; rest > 0;) {
      const std::string_view part = bytes.take(std::min(rest, k_block));
      rest -= part.size();
      crc = crc_of(crc, part);
      if (is_header) header = png_header(bytes, part);
      if (is_rows) rows->add(part);
    }
    if (crc != big_endian(bytes.take(4))) damaged();
    if (name != "IEND") continue;
    if (!rows) bytes.fail("holds no picture: no chunk IDAT");
    rows->finish();
    return header.interlaced;
  }
}

bool check_jpeg(const ByteSource& next, const fs::path& path) {
  constexpr int k_most_scans = 500;
  constexpr unsigned char k_end = 0xd9, k_scan = 0xda;
  constexpr std::size_t k_frame_header = 6;  // Precision, height, width, number of components.
  JpegBytes bytes(next, path);
  int scans = 0;
  unsigned char components = 0;
  bool progressive = false, parted = false;
  for (bytes.skip(2);;) {
    const unsigned char marker = bytes.next_marker();
    if (marker == k_end) return progressive || parted || scans > 1;
    const bool stands_alone = marker == 1 || (marker >= 0xd0 && marker <= 0xd8);
    if (stands_alone) continue;
    const std::size_t high = bytes.byte(), length = high << 8U | bytes.byte();
    if (length < 2) throw InvalidInput(path.string() + ": is damaged: a segment without length");
    std::size_t rest = length - 2;
    if (is_frame(marker) && rest >= k_frame_header) {
      progressive |= (marker & 3U) == 2;
      bytes.skip(k_frame_header - 1);
      components = bytes.byte();
      rest -= k_frame_header;
    } else if (marker == k_scan && rest > 0) {
      parted |= bytes.byte() < components;
      --rest;
    }
    bytes.skip(rest);
    if (marker == k_scan && ++scans > k_most_scans)
      throw InvalidInput(
          fmt::format("{}: has more than {} scans, each a pass over the picture", path.string(), k_most_scans));
  }
}

}  // namespace papilla::io_detail
