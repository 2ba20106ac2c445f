// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>

#include "evaluate/kinds.hpp"
#include "evaluate/picture_methods.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/resample.hpp"

namespace papilla {
namespace {

/// Memory that the methods take for a pixel, the picture included, at most: measured, 20 on 1100 x 1100 pixels.
constexpr std::size_t k_bytes_per_pixel = 24;

}  // namespace

std::vector<int> rising_sides(int shorter_side) {
  constexpr int k_first = 64, k_last = 4096;
  std::vector<int> sides;
  for (int side = k_first; side < std::min(shorter_side, k_last); side *= 2) sides.push_back(side);
  sides.push_back(std::min(shorter_side, k_last));
  return sides;
}

std::vector<EvaluationRun> evaluate_fractal(const EvaluationInput& input) {
  const GreyImage image = read_grey_image(input.file, k_bytes_per_pixel);
  const std::vector<int> sides = rising_sides(std::min(image.width, image.height));
  std::vector<EvaluationRun> runs;
  for (const FractalMethod& method : fractal_methods()) {
    EvaluationRun run{method.name, "analyze", input.name, "half width of the 95 % interval of the dimension",
                      {},          "direct",  ""};
    Ladder ladder(input.budget, k_growth_by_side);
    for (const int side : sides) {
      if (side < method.least_side) continue;
      if (!ladder.next()) break;
      const GreyImage part = middle_part(image, side);
      const Stopwatch clock;
      const std::optional<FractalEstimate> estimate = method.estimate(part);
      run.notes += estimate ? fmt::format("middle {} pixels: D {:.4f}; ", side, estimate->dimension)
                            : fmt::format("middle {} pixels: no dimension; ", side);
      if (estimate) run.trace.push_back({clock.seconds(), (estimate->high - estimate->low) / 2});
    }
    if (run.notes.empty()) run.stop = k_time_spent;
    runs.push_back(std::move(run));
    report_progress(input.progress, "fractal dimension",
                    static_cast<double>(runs.size()) / static_cast<double>(fractal_methods().size()));
  }
  return runs;
}

}  // namespace papilla
