// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "papilla/core/values.hpp"

namespace papilla {

/// A single-channel picture, row by row from the top left. Grey pictures are in [0, 1].
struct GreyImage {
  int width = 0, height = 0;
  Values<float> pixels;  ///< width * height values.
  double pitch_mm = 0;   ///< Millimetres per pixel; 0 when unknown.
  int bits = 32;         ///< Bits per sample of the file (8, 16, 32); the rounding of the values.
  /// Linear brightness over stored values from 0 to 1 at equal steps, by the file's colour profile; empty: it has none.
  std::vector<float> curve = {};

  float& at(int x, int y) { return pixels[index(x, y)]; }
  float at(int x, int y) const { return pixels[index(x, y)]; }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

/// An 8-bit RGB picture, interleaved, row by row from the top left.
struct ColorImage {
  int width = 0, height = 0;
  Values<unsigned char> pixels;  ///< 3 * width * height values.
};

}  // namespace papilla
