// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "papilla/core/values.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// Heights over a square grid, row by row, in units of the grid's pitch.
struct HeightGrid {
  int size = 0;
  Values<double> heights;  ///< size * size values.
  bool periodic = false;

  double at(int x, int y) const {
    return heights[static_cast<std::size_t>(y) * static_cast<std::size_t>(size) + static_cast<std::size_t>(x)];
  }
};

/// The surface as a grey picture stretched to [0, 1], rounded to `bits` = 8 or 16, or not at all with 32.
/// A flat surface is all 0. @throws InvalidInput for other bits or an empty surface.
GreyImage to_grey_image(const HeightGrid& surface, int bits = 32);

}  // namespace papilla
