// SPDX-License-Identifier: MIT
#include "papilla/texture/symmetry.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>

#include "evaluate/kinds.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/resample.hpp"
#include "papilla/texture/wallpaper_group.hpp"

namespace papilla {
namespace {

/// Memory that the analysis takes for a pixel, the picture included, at most: measured, 102 on 1100 x 1100 pixels,
/// where the Fourier transform is padded most.
constexpr std::size_t k_bytes_per_pixel = 104;

struct Variant {
  const char* name;
  LatticeMethod method;
  FeatureKind feature;
  int most_side;
};
constexpr std::array<Variant, 3> k_variants = {{{"best", LatticeMethod::best, FeatureKind::squared, 2048},
                                                {"projection", LatticeMethod::projection, FeatureKind::squared, 2048},
                                                {"absolute", LatticeMethod::best, FeatureKind::absolute, 512}}};

}  // namespace

std::vector<EvaluationRun> evaluate_symmetry(const EvaluationInput& input) {
  const GreyImage image = read_grey_image(input.file, k_bytes_per_pixel);
  std::vector<EvaluationRun> runs;
  for (const Variant& variant : k_variants) {
    EvaluationRun run{variant.name, "analyze", input.name, "share of the variance that the lattice does not explain",
                      {},           "direct",  ""};
    Ladder ladder(input.budget, k_growth_by_side);
    for (const int side : rising_sides(std::min({image.width, image.height, variant.most_side}))) {
      if (!ladder.next()) break;
      const GreyImage part = middle_part(image, side);
      const Stopwatch clock;
      const SymmetryAnalysis analysis = analyze_symmetry(part, {.method = variant.method}, variant.feature);
      run.trace.push_back({clock.seconds(), 1 - analysis.explained_variance()});
      run.notes += fmt::format("middle {} pixels: ", side);
      if (!analysis.lattice.found) {
        run.notes += fmt::format("no lattice, false alarm {:.3f}; ", analysis.false_alarm_probability);
        continue;
      }
      const auto& [a, b] = analysis.lattice.vectors_px;
      run.notes += fmt::format("({:.3f}, {:.3f}), ({:.3f}, {:.3f}) {}", a.x, a.y, b.x, b.y,
                               to_string(find_wallpaper_group(analysis).group));
      run.notes += analysis.deformation
                       ? fmt::format(", bent by {:.1f} % of the cell; ", analysis.deformation->rms_percent_of_cell)
                       : "; ";
    }
    if (run.trace.empty()) run.stop = k_time_spent;
    runs.push_back(std::move(run));
    report_progress(input.progress, "symmetry",
                    static_cast<double>(runs.size()) / static_cast<double>(k_variants.size()));
  }
  return runs;
}

}  // namespace papilla
