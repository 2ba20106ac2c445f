// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>

#include "evaluate/kinds.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/meshing/mesh_bounds.hpp"
#include "papilla/meshing/simplify.hpp"

namespace papilla {
namespace {

constexpr std::size_t k_most_parts = 5;
/// Of the part's diagonal: from invisible in a close-up to visible across a room.
constexpr std::array<double, 7> k_tolerances = {1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2};

/// Two curves over the ladder, and one a tolerance over the passes.
void add_runs(const std::string& name, const TriangleMesh& mesh, int passes, const Budget& budget,
              std::vector<EvaluationRun>& runs) {
  const double diagonal = bounds_of(mesh).diagonal();
  if (!(diagonal > 0)) return;
  std::vector<double> tolerances;
  for (const double relative : k_tolerances) tolerances.push_back(relative * diagonal);
  SimplifyOptions options;
  options.passes = passes;
  const std::string solver = fmt::format("{} pass{}", passes, passes == 1 ? "" : "es");
  EvaluationRun triangles{"simplification", solver + ", tolerances", name, "triangles left / before", {}, "direct", ""};
  if (budget.spent()) {
    triangles.stop = k_time_spent;
    runs.push_back(std::move(triangles));
    return;
  }
  const std::vector<SimplifyStep> steps = simplify_ladder(mesh, tolerances, options);
  EvaluationRun deviation = triangles;
  deviation.error_name = "measured deviation [mm]";
  for (const SimplifyStep& step : steps) {
    triangles.trace.push_back(
        {step.seconds, static_cast<double>(step.triangles) / static_cast<double>(mesh.triangles.size())});
    deviation.trace.push_back({step.seconds, step.deviation_bound_mm});
    triangles.notes += fmt::format("within {:.3g} mm: {} triangles, deviation {:.3g} to {:.3g} mm; ", step.tolerance_mm,
                                   step.triangles, step.deviation_mm, step.deviation_bound_mm);
  }
  deviation.notes = triangles.notes;
  runs.push_back(std::move(triangles));
  runs.push_back(std::move(deviation));
  for (const SimplifyStep& step : steps)
    runs.push_back({"simplification", fmt::format("{}, within {:.3g} mm", solver, step.tolerance_mm), name,
                    "triangles left / before", step.trace, std::string(to_string(step.stop)), ""});
}

}  // namespace

std::vector<EvaluationRun> evaluate_simplification(const EvaluationInput& input) {
  const Scene scene = read_scene(input.file, input.read, input.progress);
  std::vector<EvaluationRun> runs;
  for (const std::uint32_t number : largest_parts(scene, k_most_parts))
    for (const int passes : {1, 2, 4})
      add_runs(input_name(input, scene.parts[number].name), scene.parts[number].mesh, passes, input.budget, runs);
  return runs;
}

}  // namespace papilla
