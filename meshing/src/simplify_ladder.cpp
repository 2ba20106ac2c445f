// SPDX-License-Identifier: MIT
#include "papilla/meshing/simplify_ladder.hpp"

#include <utility>

namespace papilla {

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

}  // namespace papilla
