// SPDX-License-Identifier: MIT
#include "papilla/meshing/simplify.hpp"

#include <cmath>

#include "papilla/core/error.hpp"
#include "simplifier.hpp"

namespace papilla {
SimplifyResult simplify(const TriangleMesh& mesh, const SimplifyOptions& options) {
  const Stopwatch clock;
  if (!std::isfinite(options.tolerance_mm) && options.target_triangles == 0)
    throw InvalidInput("simplify: neither a tolerance nor a target is given");
  const detail::Simplifier simplifier(mesh, options, "simplify");
  Trace trace;
  std::vector<Index> indices;
  if (std::isfinite(options.tolerance_mm)) {
    indices = simplifier.within(simplifier.all(), options.tolerance_mm, options.target_triangles, clock, trace);
  } else {
    constexpr double k_unlimited = 10;  // times the diagonal
    indices = simplifier.collapse(simplifier.all(), k_unlimited * simplifier.diagonal(), options.target_triangles);
  }
  SimplifyResult result = simplifier.result(indices, options.tolerance_mm);
  result.trace = std::move(trace);
  if (options.target_triangles > 0 && result.mesh.triangles.size() > options.target_triangles)
    result.stop = StopReason::iteration_limit;
  return result;
}

}  // namespace papilla
