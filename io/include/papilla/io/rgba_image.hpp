// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "papilla/io/scene.hpp"

namespace papilla {

/// An 8-bit picture with alpha, interleaved, row by row from the top left; colours are not multiplied by alpha.
struct RgbaImage {
  int width = 0, height = 0;
  std::vector<unsigned char> pixels;  ///< 4 * width * height values.
};

/// decode_image() with alpha, which is 255 where the picture has none.
/// @throws InvalidInput as decode_image().
RgbaImage decode_rgba_image(const Scene& scene, std::size_t image);

/// The picture as an 8-bit RGBA PNG file, without metadata. The same picture gives the same bytes.
/// @throws InvalidInput when the number of values does not fit the size.
std::vector<std::byte> encode_png(const RgbaImage& image);

}  // namespace papilla
