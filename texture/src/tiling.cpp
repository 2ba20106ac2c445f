// SPDX-License-Identifier: MIT
#include "papilla/texture/tiling.hpp"

#include <algorithm>
#include <cmath>

#include "checks.hpp"

namespace papilla {
namespace {

/// Step between line `from` and line `to`, a line being a column or a row.
double mean_step(const GreyImage& image, bool columns, int from, int to) {
  const int length = columns ? image.height : image.width;
  double sum = 0;
  for (int i = 0; i < length; ++i) {
    const float a = columns ? image.at(from, i) : image.at(i, from), b = columns ? image.at(to, i) : image.at(i, to);
    sum += std::abs(static_cast<double>(b) - static_cast<double>(a));
  }
  return sum / length;
}

/// Step across the seam relative to the strongest one inside; 0 for a seam without step.
double seam(const GreyImage& image, bool columns) {
  const int count = columns ? image.width : image.height;
  const double across = mean_step(image, columns, count - 1, 0);
  double strongest = 0;
  for (int i = 0; i + 1 < count; ++i) strongest = std::max(strongest, mean_step(image, columns, i, i + 1));
  if (across <= 0) return 0;
  constexpr double k_no_step_inside = 1e6;
  return strongest > 0 ? std::min(k_no_step_inside, across / strongest) : k_no_step_inside;
}

}  // namespace

Tiling measure_tiling(const GreyImage& image) {
  texture_detail::require_image(image, "measure_tiling");
  Tiling tiling;
  tiling.seam_x = seam(image, true);
  tiling.seam_y = seam(image, false);
  // Rounding of the picture's values must not decide on an exactly periodic one.
  constexpr double k_rounding = 1.001;
  tiling.tiles = std::max(tiling.seam_x, tiling.seam_y) <= k_rounding;
  return tiling;
}

}  // namespace papilla
