// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "papilla/texture/height_map.hpp"
#include "papilla/texture/image.hpp"
#include "papilla/texture/sample_rows.hpp"

namespace papilla {

struct Scene;

/// Pictures of more pixels than this are refused before memory is taken for them.
inline constexpr std::size_t k_max_image_pixels = std::size_t{32768} * 32768;

/// Reads a picture (PNG, JPEG, TIFF, OpenEXR, PNM, PFM, HDR, BMP, GIF, WebP, DPX, PSD, TGA) as grey values: integers
/// are divided by their largest value, floats stay as they are. Colours become their Rec. 709 luminance 0.2126 R +
/// 0.7152 G + 0.0722 B of the stored values (no gamma is undone); alpha is ignored. `pitch_mm` comes from the file's
/// resolution (dots per inch or centimetre), 0 when it has none or one pixel would not be square.
/// @param bytes_per_pixel what the caller is going to take for a pixel, the grey value included.
/// @throws IoError when the file can't be read; InvalidInput naming the file when it is no picture or takes more than
///         picture_memory(), the row when it is damaged, the pixel when a float is not finite or over a million.
GreyImage read_grey_image(const std::filesystem::path& path, std::size_t bytes_per_pixel = sizeof(float));

/// Reads a picture of the same formats as 8-bit RGB; grey is repeated, alpha ignored.
/// @param bytes_per_pixel what the caller is going to take for a pixel, its colour included.
/// @throws IoError, InvalidInput as read_grey_image().
ColorImage read_color_image(const std::filesystem::path& path, std::size_t bytes_per_pixel = 3);

/// Both of a picture, decoded once.
struct Picture {
  GreyImage grey;
  ColorImage color;
  int file_bits = 8;      ///< A sample in the file, where `grey` is of means.
  int pixels_a_side = 1;  ///< So many pixels of the file a side make one.
};

/// read_grey_image() and read_color_image() of one file.
/// @param bytes_per_pixel what the caller is going to take for a pixel, grey value and colour included.
/// @throws IoError, InvalidInput as read_grey_image().
Picture read_picture(const std::filesystem::path& path, std::size_t bytes_per_pixel = sizeof(float) + 3);

/// read_picture() of one that may be larger than what is wanted of it: where a side is longer than `most_side`, both
/// are means over n × n pixels, n the least that makes them no longer, and the pitch is n times as large. Memory: the
/// result and what ImageBands takes, whatever the picture.
/// @param bytes_per_pixel what the caller is going to take for a pixel of the result, grey value and colour included.
/// @throws IoError, InvalidInput as ImageBands and read_grey_image().
Picture read_reduced_picture(const std::filesystem::path& path, int most_side,
                             std::size_t bytes_per_pixel = sizeof(float) + 3);

/// read_grey_image() of one for which picture_memory() may have no room at so many bytes a pixel: it is reduced as by
/// read_reduced_picture() until it has. Without its colours.
/// @throws IoError, InvalidInput as read_reduced_picture().
Picture read_fitting_picture(const std::filesystem::path& path, std::size_t bytes_per_pixel);

/// The same as read_color_image() for a picture in memory, PNG or JPEG; `name` only names it in messages.
/// @throws InvalidInput as read_color_image().
ColorImage decode_color_image(std::span<const std::byte> bytes, const std::string& name);

/// What messages call a picture of the scene: its name, its file, or its number.
std::string picture_name(const Scene& scene, std::size_t image);

/// decode_color_image() of a picture of the scene, called by picture_name().
/// @throws InvalidInput as decode_color_image().
ColorImage decode_image(const Scene& scene, std::size_t image);

/// The picture as an 8-bit RGB PNG file, without metadata. The same picture gives the same bytes.
/// @pre pixels.size() == 3 * width * height.
std::vector<std::byte> encode_png(const ColorImage& image);

/// A height map as a 16-bit grey PNG: h = offset_mm + scale_mm · v / 65535, v = 0 … 65535, white is outward.
struct EncodedHeight {
  std::vector<std::byte> png;  ///< Without gamma, colour profile, text or time.
  double scale_mm = 0;         ///< Range of the heights; 0 for a flat map, whose samples are all 0.
  double offset_mm = 0;        ///< Lowest height.
};

/// Quantises to 65536 steps between the lowest and the highest sample: the error is at most scale_mm / 131070.
/// @throws InvalidInput when the map is empty or a height is not finite.
EncodedHeight encode_height_png16(const HeightMap& map);

/// Writes a grey picture in the format of the extension; values are clamped to [0, 1] for integer formats. Its curve
/// goes with it as a colour profile, but not into .exr.
/// @param bits  8, 16, or 32 (float; EXR, TIFF).
/// @param jpeg_quality  1 to 100, of .jpg.
/// @throws InvalidInput when the extension names no writable format or it has not that depth; IoError when writing
/// fails.
void write_grey_image(const std::filesystem::path& path, const GreyImage& image, int bits, int jpeg_quality = 98);

/// Writes the heights in millimetres as 32-bit floats to .exr, .tif or .tiff, with the pitch as resolution.
/// @throws InvalidInput, IoError as write_grey_image().
void write_height_float(const std::filesystem::path& path, const HeightMap& map);

/// Writes heights of 0 to `depth_mm` row by row, whatever their number: 16-bit grey .png as encode_height_png16(), or
/// .exr, .tif, .tiff as write_height_float().
/// @throws InvalidInput, IoError as write_grey_image().
void write_height_rows(const std::filesystem::path& path, const SampleRows& heights_mm, double depth_mm,
                       double pitch_mm);

/// @throws InvalidInput, IoError as write_grey_image().
void write_color_image(const std::filesystem::path& path, const ColorImage& image);

}  // namespace papilla
