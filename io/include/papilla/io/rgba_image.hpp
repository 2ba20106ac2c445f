// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "papilla/core/values.hpp"

namespace papilla {

struct Scene;

/// An 8-bit picture with alpha, interleaved, row by row from the top left. Colours are not multiplied by alpha.
struct RgbaImage {
  int width = 0, height = 0;
  Values<unsigned char> pixels;  ///< 4 * width * height values.

  const unsigned char* at(int x, int y) const {
    return &pixels[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x))];
  }
  unsigned char* at(int x, int y) { return const_cast<unsigned char*>(std::as_const(*this).at(x, y)); }
};

/// Whether some pixel is not opaque.
bool has_alpha(const RgbaImage& image) noexcept;

/// Reads a picture of the formats of read_grey_image() with its alpha; grey is repeated, a picture without alpha is
/// opaque. Pictures of floats are read as read_color_image() does.
/// @throws IoError, InvalidInput as read_grey_image().
RgbaImage read_rgba_image(const std::filesystem::path& path);

/// The same of a PNG or JPEG in memory; `name` only names it in messages.
/// @throws InvalidInput as read_rgba_image().
RgbaImage decode_rgba_image(std::span<const std::byte> bytes, const std::string& name);

/// decode_rgba_image() of a picture of the scene, called as by decode_image().
RgbaImage decode_rgba_image(const Scene& scene, std::size_t image);

/// The picture as an 8-bit RGBA PNG file, without metadata. The same picture gives the same bytes.
/// @pre pixels.size() == 4 * width * height.
std::vector<std::byte> encode_png(const RgbaImage& image);

/// A picture of linear light, RGB, interleaved, row by row from the top left; values are finite and at least 0.
struct LinearImage {
  int width = 0, height = 0;
  Values<float> pixels;  ///< 3 * width * height values.

  const float* at(int x, int y) const {
    return &pixels[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x))];
  }
};

/// Reads a picture as linear light: floats (OpenEXR, Radiance HDR, PFM, TIFF) as they are, negative ones as 0, integers
/// as sRGB, 1 for the largest.
/// @throws IoError, InvalidInput as read_grey_image(); InvalidInput naming the pixel when a float is not finite.
LinearImage read_linear_image(const std::filesystem::path& path);

}  // namespace papilla
