// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>

namespace papilla::texture_detail {

/// Catmull-Rom weights of the samples at −1, 0, 1, 2 for a position `u` in [0, 1] between the samples 0 and 1.
inline std::array<double, 4> catmull_rom(double u) {
  return {((-0.5 * u + 1) * u - 0.5) * u, (1.5 * u - 2.5) * u * u + 1, ((-1.5 * u + 2) * u + 0.5) * u,
          (0.5 * u - 0.5) * u * u};
}

/// Interpolates between samples given by pixel(x, y) at (x, y); exact at whole positions.
template <typename Pixel>
double bicubic(double x, double y, const Pixel& pixel) {
  const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
  const std::array<double, 4> across = catmull_rom(x - left), down = catmull_rom(y - top);
  double sum = 0;
  for (int j = 0; j < 4; ++j) {
    double row = 0;
    for (int i = 0; i < 4; ++i)
      row += across[static_cast<std::size_t>(i)] * static_cast<double>(pixel(left + i - 1, top + j - 1));
    sum += down[static_cast<std::size_t>(j)] * row;
  }
  return sum;
}

}  // namespace papilla::texture_detail
