// SPDX-License-Identifier: MIT
#include "papilla/texture/tiling.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "checks.hpp"

namespace papilla {
namespace {

/// Mean |difference| between each line and the next one, and from the last one to the first; a line is a column or a
/// row. Row by row in memory either way.
std::vector<double> mean_steps(const GreyImage& image, bool columns) {
  const int count = columns ? image.width : image.height, length = columns ? image.height : image.width;
  std::vector<double> steps(static_cast<std::size_t>(count), 0.0);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float next = columns ? image.at(x + 1 < count ? x + 1 : 0, y) : image.at(x, y + 1 < count ? y + 1 : 0);
      steps[static_cast<std::size_t>(columns ? x : y)] +=
          std::abs(static_cast<double>(next) - static_cast<double>(image.at(x, y)));
    }
  for (double& step : steps) step /= length;
  return steps;
}

/// Step across the seam relative to the strongest one inside; 0 for a seam without step.
double seam(const GreyImage& image, bool columns) {
  std::vector<double> steps = mean_steps(image, columns);
  const double across = steps.back();
  steps.back() = 0;
  const double strongest = *std::max_element(steps.begin(), steps.end());
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
