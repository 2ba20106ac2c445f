// SPDX-License-Identifier: MIT
#include "papilla/meshing/simplify.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "papilla/core/error.hpp"
#include "simplifier.hpp"

namespace papilla {
namespace {

SimplifyOptions in_time(const TriangleMesh& mesh, SimplifyOptions options) {
  options.deadline = options.deadline.earlier_by(detail::seconds_to_measure(mesh.triangles.size()));
  return options;
}

}  // namespace

SimplifyResult simplify(const TriangleMesh& mesh, const SimplifyOptions& options) {
  const Stopwatch clock;
  if (!std::isfinite(options.tolerance_mm) && options.target_triangles == 0)
    throw InvalidInput("simplify: neither a tolerance nor a target is given");
  const detail::Simplifier simplifier(mesh, in_time(mesh, options), "simplify");
  Trace trace;
  std::vector<Index> indices;
  if (std::isfinite(options.tolerance_mm)) {
    indices = simplifier.within(simplifier.all(), options.tolerance_mm, options.target_triangles, clock, trace,
                                options.progress);
  } else {
    constexpr double k_unlimited = 10;  // times the diagonal
    indices = simplifier.collapse(simplifier.all(), k_unlimited * simplifier.diagonal(), options.target_triangles);
  }
  SimplifyResult result = simplifier.result(indices, options.tolerance_mm);
  result.trace = std::move(trace);
  if (options.target_triangles > 0 && result.mesh.triangles.size() > options.target_triangles)
    result.stop = StopReason::iteration_limit;
  if (simplifier.is_out_of_time()) result.stop = StopReason::time_limit;
  return result;
}

std::vector<SimplifyStep> simplify_ladder(const TriangleMesh& mesh, std::span<const double> tolerances_mm,
                                          const SimplifyOptions& options) {
  std::vector<SimplifyStep> steps;
  for (const double tolerance : tolerances_mm) {
    SimplifyOptions at_step = options;
    at_step.tolerance_mm = tolerance;
    at_step.target_triangles = 0;
    const Stopwatch clock;
    SimplifyResult result = simplify(mesh, at_step);
    steps.push_back({tolerance, clock.seconds(), result.mesh.triangles.size(), result.deviation.value(),
                     result.deviation.bound(), result.stop, std::move(result.trace)});
  }
  return steps;
}

std::vector<SimplifyResult> levels_of_detail(const TriangleMesh& mesh, std::span<const double> tolerances_mm,
                                             const SimplifyOptions& options) {
  for (std::size_t i = 0; i < tolerances_mm.size(); ++i)
    if (!(tolerances_mm[i] > (i == 0 ? 0 : tolerances_mm[i - 1])) || !std::isfinite(tolerances_mm[i]))
      throw InvalidInput("levels_of_detail: tolerances_mm[" + std::to_string(i) + "] does not ascend from 0");
  const Stopwatch clock;
  const detail::Simplifier simplifier(mesh, in_time(mesh, options), "levels_of_detail");
  std::vector<SimplifyResult> levels;
  std::vector<Index> indices = simplifier.all();
  const auto count = static_cast<double>(tolerances_mm.size());
  for (const double tolerance : tolerances_mm) {
    const auto level = static_cast<double>(levels.size());
    Trace trace;
    indices = simplifier.within(std::move(indices), tolerance, 0, clock, trace,
                                progress_within(options.progress, level / count, (level + 1) / count));
    levels.push_back(simplifier.result(indices, tolerance));
    levels.back().trace = std::move(trace);
    if (simplifier.is_out_of_time()) levels.back().stop = StopReason::time_limit;
  }
  return levels;
}

}  // namespace papilla
