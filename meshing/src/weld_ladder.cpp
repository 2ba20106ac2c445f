// SPDX-License-Identifier: MIT
#include "papilla/meshing/weld_ladder.hpp"

#include <cmath>
#include <string>

#include "edge_table.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"

namespace papilla {

std::vector<WeldStep> weld_ladder(const TriangleMesh& mesh, std::span<const double> tolerances_mm,
                                  const WeldOptions& options) {
  std::vector<WeldStep> steps;
  for (std::size_t i = 0; i < tolerances_mm.size(); ++i) {
    if (!(tolerances_mm[i] >= 0) || !std::isfinite(tolerances_mm[i]))
      throw InvalidInput("weld_ladder: tolerances_mm[" + std::to_string(i) + "] is negative or not finite");
    WeldOptions at_step = options;
    at_step.tolerance_mm = tolerances_mm[i];
    TriangleMesh copy = mesh;
    const Stopwatch clock;
    const WeldResult welded = weld(std::move(copy), at_step);
    WeldStep step;
    step.seconds = clock.seconds();
    step.tolerance_mm = tolerances_mm[i];
    step.max_deviation_mm = welded.max_deviation_mm;
    step.triangles = welded.mesh.triangles.size();
    const detail::EdgeTable edges(welded.mesh.triangles, welded.mesh.positions.size());
    for (std::size_t e = 0; e < edges.size(); ++e) {
      step.boundary_edges += edges.halfedges(e).size() == 1 ? 1u : 0u;
      step.nonmanifold_edges += edges.halfedges(e).size() > 2 ? 1u : 0u;
    }
    steps.push_back(step);
  }
  return steps;
}

}  // namespace papilla
