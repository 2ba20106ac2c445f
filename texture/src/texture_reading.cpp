// SPDX-License-Identifier: MIT
#include "papilla/texture/texture_reading.hpp"

#include <algorithm>
#include <string>

#include "checks.hpp"
#include "papilla/core/error.hpp"
#include "papilla/texture/fractal_readings.hpp"

namespace papilla {

const PlanStep& step_of(const AnalysisPlan& plan, std::string_view step) {
  const auto found = std::find_if(plan.begin(), plan.end(), [&](const PlanStep& s) { return s.step == step; });
  if (found == plan.end()) throw InvalidInput("step_of: the plan has no step '" + std::string(step) + "'");
  return *found;
}

TextureReading read_texture(const GreyImage& image, const ReadingOptions& options) {
  texture_detail::require_image(image, "read_texture");
  TextureReading reading;
  report_progress(options.progress, "symmetry", 0);
  if (options.deadline.passed())
    reading.stop = StopReason::time_limit;
  else
    reading.symmetry = analyze_symmetry(image, options.lattice, options.feature, options.progress);
  report_progress(options.progress, "symmetry", 1);
  const Lattice& lattice = reading.symmetry.lattice;
  reading.kind = classify(image, reading.symmetry.explained_variance(), lattice.stripes);
  reading.suitability = measure_suitability(image, lattice);
  reading.plan = plan_analysis(reading.kind, reading.suitability);
  if (step_of(reading.plan, "generating_region").run) reading.group = find_wallpaper_group(reading.symmetry);
  if (options.roughness && step_of(reading.plan, "fractal_dimension").run) {
    const GreyImage& rough = step_of(reading.plan, "primitive").run ? reading.symmetry.part->residual : image;
    if (options.deadline.passed())
      reading.stop = StopReason::time_limit;
    else if (std::min(rough.width, rough.height) >= k_least_fractal_side)
      reading.roughness = best_dimension(rough);
  }
  return reading;
}

}  // namespace papilla
