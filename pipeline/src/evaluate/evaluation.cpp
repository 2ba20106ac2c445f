// SPDX-License-Identifier: MIT
#include "papilla/pipeline/evaluate/evaluation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>

#include "evaluate/kinds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/temporary_folder.hpp"

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

/// Adds a further repeat of the same runs: samples with equal errors get the median of their times.
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

/// The file's own name, with its folder when another file has the same name.
std::string report_name(const std::string& file, const std::vector<std::string>& files) {
  const std::filesystem::path name = std::filesystem::path(file).filename();
  const auto alike = std::count_if(files.begin(), files.end(), [&](const std::string& other) {
    return std::filesystem::path(other).filename() == name;
  });
  return alike > 1 ? file : name.string();
}

}  // namespace

std::span<const EvaluationKind> evaluation_kinds() { return k_kinds; }

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

Evaluation evaluate(const EvaluateOptions& options, const ProgressCallback& progress) {
  const auto kind = std::find_if(k_kinds.begin(), k_kinds.end(),
                                 [&](const EvaluationKind& candidate) { return candidate.name == options.kind; });
  if (kind == k_kinds.end()) throw InvalidInput("evaluate: there is no kind '" + options.kind + "'");
  Evaluation evaluation{options.files, {}};
  std::optional<TemporaryFolder> folder;
  if (options.files.empty())
    evaluation.files = write_built_in_inputs(kind->name, folder.emplace("papilla-evaluate").path());
  for (const std::string& file : evaluation.files) {
    const EvaluationInput input{
        file, report_name(file, evaluation.files), options.read, progress, Budget(options.seconds), options.param};
    std::vector<EvaluationRun> runs = run_repeatedly(*kind, input, options.repeats);
    std::move(runs.begin(), runs.end(), std::back_inserter(evaluation.runs));
  }
  return evaluation;
}

Trace pareto_front(const std::vector<Trace>& traces) {
  Trace all, front;
  for (const Trace& trace : traces)
    std::copy_if(trace.begin(), trace.end(), std::back_inserter(all),
                 [](const TraceSample& s) { return std::isfinite(s.error); });
  std::stable_sort(all.begin(), all.end(), [](const TraceSample& a, const TraceSample& b) {
    return a.seconds != b.seconds ? a.seconds < b.seconds : a.error < b.error;
  });
  for (const TraceSample& s : all)
    if (front.empty() || s.error < front.back().error) front.push_back(s);
  return front;
}

bool reaches_front(const Trace& trace, const Trace& front) {
  return std::any_of(trace.begin(), trace.end(), [&](const TraceSample& s) {
    return std::any_of(front.begin(), front.end(),
                       [&](const TraceSample& f) { return f.seconds == s.seconds && f.error == s.error; });
  });
}

std::vector<EvaluationGroup> group_runs(const std::vector<EvaluationRun>& runs) {
  std::vector<EvaluationGroup> groups;
  std::map<std::pair<std::string, std::string>, std::size_t> index;
  for (const EvaluationRun& run : runs) {
    const auto [at, added] = index.try_emplace({run.input, run.error_name}, groups.size());
    if (added) groups.push_back({run.input, run.error_name, {}, {}, {}});
    groups[at->second].runs.push_back(&run);
  }
  for (EvaluationGroup& group : groups) {
    std::vector<Trace> traces;
    for (const EvaluationRun* run : group.runs)
      if (run->valid) traces.push_back(run->trace);
    group.front = pareto_front(traces);
    for (const EvaluationRun* run : group.runs)
      if (run->valid && reaches_front(run->trace, group.front)) group.on_front.push_back(run->name());
  }
  return groups;
}

}  // namespace papilla
