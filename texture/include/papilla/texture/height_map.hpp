// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "papilla/core/values.hpp"

namespace papilla {

/// Relief over a rectangle in millimetres, outward positive, row by row from the top left.
/// Sample (x, y) covers the square of side `pitch_mm` around ((x+½), (y+½))·pitch_mm.
struct HeightMap {
  int width = 0, height = 0;
  Values<float> mm;  ///< width * height heights.
  double pitch_mm_x = 0, pitch_mm_y = 0;
  bool periodic = false;  ///< True when the right neighbour of the last column is the first one, and likewise for rows.

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  float at(int x, int y) const { return mm[index(x, y)]; }
  float& at(int x, int y) { return mm[index(x, y)]; }
};

}  // namespace papilla
