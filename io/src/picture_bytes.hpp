// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>

namespace papilla::io_detail {

/// Up to that many next bytes of a file; fewer only at its end.
using ByteSource = std::function<std::string_view(std::size_t)>;

ByteSource source_of(std::string_view bytes);

struct PictureFormat {
  std::string_view name = {};  ///< OpenImageIO's; empty: none that is read.
  bool in_rows = false;        ///< Its reader holds some rows at a time, not the whole picture.
};

/// By the first bytes; by the extension for Targa, which has no signature. What a reader would decode when it opens a
/// file, before the size is known, is not read at all (JPEG 2000, HEIF, camera raw, video).
PictureFormat picture_format(std::string_view first_bytes, const std::filesystem::path& path);

/// What readers that take memory for the whole picture when they open a file (GIF, BMP, WebP) would take it for; 0 x 0
/// for all others.
struct AnnouncedSize {
  std::uint64_t width = 0, height = 0;
};
AnnouncedSize announced_size(std::string_view format, std::string_view first_bytes);

/// Bytes that picture_format(), announced_size() and check_bmp() look at: the header of a BMP as far as it is checked.
inline constexpr std::size_t k_first_bytes = 34;

/// OpenImageIO 2.4.7 reads behind its buffers where the compression of a BMP does not fit its bits a pixel. Header:
/// BITMAPFILEHEADER of 14 bytes, size of the next one, and from 40 bytes on bits a pixel and compression.
/// @throws InvalidInput naming `path`.
void check_bmp(std::string_view first_bytes, const std::filesystem::path& path);

/// Reads a PNG to its end: checksums and order of the chunks, header, and the compressed rows. libpng then finds
/// nothing to print about. @returns whether the rows come in several passes, so that the reader holds the whole
/// picture.
/// @throws InvalidInput naming `path` and the chunk or row that is damaged.
bool check_png(const ByteSource& next, const std::filesystem::path& path);

/// Reads the markers of a JPEG [ITU-T T.81, B]. @returns whether the reader holds the whole picture, as libjpeg does
/// when the frame is progressive, the first scan has not all of its components, or there are several scans.
/// @throws InvalidInput naming `path` when the file ends early or has more than 500 scans, each of which costs a pass.
bool check_jpeg(const ByteSource& next, const std::filesystem::path& path);

}  // namespace papilla::io_detail
