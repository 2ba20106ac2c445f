// SPDX-License-Identifier: MIT
#include "papilla/meshing/weld.hpp"

#include <fmt/format.h>

#include <array>

#include "evaluate/kinds.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/meshing/mesh_bounds.hpp"

namespace papilla {
namespace {

constexpr std::size_t k_most_parts = 5;
/// Of the part's diagonal: from below single precision to above any gap in CAD exports.
constexpr std::array<double, 9> k_tolerances = {1e-9, 1e-8, 1e-7, 3e-7, 1e-6, 3e-6, 1e-5, 1e-4, 1e-3};

std::string step_notes(const WeldStep& step) {
  return fmt::format("tolerance {:.3g} mm: {} boundary and {} non-manifold edges, {} triangles, moved {:.3g} mm; ",
                     step.tolerance_mm, step.boundary_edges, step.nonmanifold_edges, step.triangles,
                     step.max_deviation_mm);
}

}  // namespace

std::vector<EvaluationRun> evaluate_weld(const EvaluationInput& input) {
  const Scene scene = read_scene(input.file, input.read, input.progress);
  std::vector<EvaluationRun> runs;
  for (const std::uint32_t number : largest_parts(scene, k_most_parts)) {
    const Part& part = scene.parts[number];
    const double diagonal = bounds_of(part.mesh).diagonal();
    if (!(diagonal > 0)) continue;
    std::vector<double> tolerances;
    for (const double relative : k_tolerances) tolerances.push_back(relative * diagonal);
    EvaluationRun edges{"weld", "boundary vertices", input_name(input, part.name), "boundary edges left", {}, "direct",
                        ""};
    EvaluationRun moved = edges;
    moved.error_name = "largest deviation [mm]";
    for (const WeldStep& step : weld_ladder(part.mesh, tolerances)) {
      edges.trace.push_back({step.seconds, static_cast<double>(step.boundary_edges)});
      moved.trace.push_back({step.seconds, step.max_deviation_mm});
      edges.notes += step_notes(step);
    }
    moved.notes = edges.notes;
    runs.push_back(std::move(edges));
    runs.push_back(std::move(moved));
  }
  return runs;
}

}  // namespace papilla
