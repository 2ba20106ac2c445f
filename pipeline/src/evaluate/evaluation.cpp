// SPDX-License-Identifier: MIT
#include "papilla/pipeline/evaluate/evaluation.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <numeric>

namespace papilla {
namespace {

constexpr std::array<EvaluationKind, 9> k_kinds = {{
    {"param", "every method of unwrap on one chart: distortion against run time", evaluate_param},
    {"weld", "tolerance of the weld against boundary edges left and deviation", evaluate_weld},
    {"charts", "cost of seams against distortion of the charts and length of the seams", evaluate_charts},
    {"simplification", "tolerance of simplify against triangles left and deviation", evaluate_simplification},
    {"tessellation", "chord of CAD tessellation against deviation", evaluate_tessellation},
    {"fractal", "size of the picture against the interval of every fractal dimension", evaluate_fractal},
    {"symmetry", "size of the picture against what the lattice leaves unexplained", evaluate_symmetry},
    {"height", "steps of shape from shading, or size of the picture, against depth error or residual", evaluate_height},
    {"contact", "rate of the loop against the error of the force, and where walls shake, on a tagged glTF file",
     evaluate_contact},
}};

/// The time of every sample: the median over the repeats that have it.
void take_medians(EvaluationRun& run) {
  for (std::size_t i = 0; i < run.trace.size(); ++i) {
    std::vector<double> seconds;
    for (const Trace& repeat : run.repeats)
      if (i < repeat.size() && repeat[i].error == run.trace[i].error) seconds.push_back(repeat[i].seconds);
    if (seconds.empty()) continue;
    const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>((seconds.size() - 1) / 2);
    std::nth_element(seconds.begin(), middle, seconds.end());
    run.trace[i].seconds = *middle;
  }
}

}  // namespace

std::span<const EvaluationKind> evaluation_kinds() { return k_kinds; }

void merge_repeat(std::vector<EvaluationRun>& runs, const std::vector<EvaluationRun>& repeat) {
  for (EvaluationRun& run : runs) {
    const auto same = std::find_if(repeat.begin(), repeat.end(), [&](const EvaluationRun& other) {
      return other.name() == run.name() && other.input == run.input && other.error_name == run.error_name;
    });
    if (same == repeat.end()) continue;
    run.repeats.push_back(same->trace);
    take_medians(run);
  }
}

std::vector<EvaluationRun> run_repeatedly(const EvaluationKind& kind, const EvaluationInput& input, int repeats) {
  const Stopwatch clock;
  std::vector<EvaluationRun> runs = kind.run(input);
  const double once = clock.seconds();
  for (EvaluationRun& run : runs) run.repeats = {run.trace};
  for (int i = 1; i < repeats && input.budget.allows(once); ++i) merge_repeat(runs, kind.run(input));
  return runs;
}

std::vector<std::uint32_t> largest_parts(const Scene& scene, std::size_t most) {
  std::vector<std::uint32_t> order(scene.parts.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return scene.parts[a].mesh.triangles.size() > scene.parts[b].mesh.triangles.size();
  });
  order.resize(std::min(order.size(), most));
  return order;
}

std::string input_name(const EvaluationInput& input, const std::string& part) {
  const bool same = part.empty() || std::filesystem::path(input.name).stem() == part;
  return same ? input.name : input.name + ": " + part;
}

}  // namespace papilla
