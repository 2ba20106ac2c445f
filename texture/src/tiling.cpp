// SPDX-License-Identifier: MIT
#include "papilla/texture/tiling.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "checks.hpp"
#include "papilla/texture/stored_samples.hpp"
#include "row_window.hpp"

namespace papilla {
namespace {

/// Mean |difference| between each line and the next one, and from the last one to the first; a line is a column or a
/// row.
struct MeanSteps {
  std::vector<double> columns, rows;
};

MeanSteps mean_steps(const SampleRows& picture) {
  const auto width = static_cast<std::size_t>(picture.width()), height = static_cast<std::size_t>(picture.height());
  MeanSteps steps{std::vector<double>(width, 0.0), std::vector<double>(height, 0.0)};
  const auto difference = [](float a, float b) { return std::abs(static_cast<double>(b) - static_cast<double>(a)); };
  texture_detail::visit_rows(picture, true, [&](int y, const texture_detail::RowWindow& rows) {
    double& down = steps.rows[static_cast<std::size_t>(y)];
    for (std::size_t x = 0; x < width; ++x) {
      steps.columns[x] += difference(rows.row[x], rows.row[x + 1 < width ? x + 1 : 0]);
      down += difference(rows.row[x], rows.below[x]);
    }
  });
  for (double& step : steps.columns) step /= static_cast<double>(height);
  for (double& step : steps.rows) step /= static_cast<double>(width);
  return steps;
}

/// Step across the seam relative to the strongest one inside; 0 for a seam without step.
double seam(std::vector<double> steps) {
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
  return measure_tiling(SamplesInMemory(image.pixels, image.width, image.height));
}

Tiling measure_tiling(const SampleRows& picture) {
  MeanSteps steps = mean_steps(picture);
  Tiling tiling;
  tiling.seam_x = seam(std::move(steps.columns));
  tiling.seam_y = seam(std::move(steps.rows));
  // Rounding of the picture's values must not decide on an exactly periodic one.
  constexpr double k_rounding = 1.001;
  tiling.tiles = std::max(tiling.seam_x, tiling.seam_y) <= k_rounding;
  return tiling;
}

}  // namespace papilla
