// SPDX-License-Identifier: MIT
#include "papilla/meshing/levels_of_detail.hpp"

#include <cmath>
#include <string>

#include "papilla/core/error.hpp"
#include "simplifier.hpp"

namespace papilla {

std::vector<SimplifyResult> levels_of_detail(const TriangleMesh& mesh, std::span<const double> tolerances_mm,
                                             const SimplifyOptions& options) {
  for (std::size_t i = 0; i < tolerances_mm.size(); ++i)
    if (!(tolerances_mm[i] > (i == 0 ? 0 : tolerances_mm[i - 1])) || !std::isfinite(tolerances_mm[i]))
      throw InvalidInput("levels_of_detail: tolerances_mm[" + std::to_string(i) + "] does not ascend from 0");
  const Stopwatch clock;
  const detail::Simplifier simplifier(mesh, options, "levels_of_detail");
  std::vector<SimplifyResult> levels;
  std::vector<Index> indices = simplifier.all();
  for (const double tolerance : tolerances_mm) {
    Trace trace;
    indices = simplifier.within(std::move(indices), tolerance, 0, clock, trace);
    levels.push_back(simplifier.result(indices, tolerance));
    levels.back().trace = std::move(trace);
  }
  return levels;
}

}  // namespace papilla
