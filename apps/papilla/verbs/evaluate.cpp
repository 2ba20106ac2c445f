// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <ctime>
#include <memory>
#include <optional>

#include "evaluate/evaluation_files.hpp"
#include "exit_code.hpp"
#include "file_options.hpp"
#include "json/evaluation_json.hpp"
#include "option_checks.hpp"
#include "options/scene_option.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

constexpr const char* k_stability = "stability";

struct Options {
  EvaluateOptions evaluate;
  std::string folder;
  SceneOptions read;
  std::optional<double> seconds;
};

Json write_stability(Json json, EvaluationFolder& folder, const EvaluateOptions& options, VerbContext& context) {
  const std::vector<StabilitySuite> suites = evaluate_stability(options.seconds, context.progress);
  json["suites"] = stability_json(suites);
  context.console.print(stability_summary(suites));
  folder.write(".json", json_text(json));
  folder.write(".csv", stability_csv(suites));
  folder.write(".md", stability_markdown(suites));
  folder.write(".html", stability_html(suites));
  return json;
}

Json write_runs(Json json, EvaluationFolder& folder, const EvaluateOptions& options, VerbContext& context) {
  const Evaluation evaluation = evaluate(options, context.progress);
  const std::vector<EvaluationGroup> groups = group_runs(evaluation.runs);
  const std::vector<EvaluationPicture> pictures = runs_pictures(groups);
  json["options"]["files"] = evaluation.files;
  json["runs"] = runs_json(evaluation.runs);
  json["pareto"] = pareto_json(groups);
  context.console.print(runs_summary(evaluation.runs, groups));
  folder.write(".json", json_text(json));
  folder.write(".csv", runs_csv(evaluation.runs));
  folder.write(".html", runs_html(options.kind, pictures, evaluation.runs));
  for (std::size_t i = 0; i < pictures.size(); ++i) folder.write(fmt::format("-{}.svg", i + 1), pictures[i].svg);
  return json;
}

Json run(const Options& options, VerbContext& context) {
  EvaluateOptions evaluation = options.evaluate;
  const bool is_stability = evaluation.kind == k_stability;
  if (is_stability && !evaluation.files.empty())
    throw UsageError("evaluate stability: has its own inputs and takes no FILE");
  evaluation.read = options.read.read_options();
  evaluation.seconds = options.seconds.value_or(is_stability ? k_stability_seconds : evaluation.seconds);
  EvaluationFolder folder(options.folder, evaluation.kind);
  Json json = evaluation_json(evaluation, std::time(nullptr), context.threads, context.seed);
  json = (is_stability ? write_stability : write_runs)(std::move(json), folder, evaluation, context);
  json["files"] = folder.files();
  return json;
}

}  // namespace

void add_evaluate(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = add_verb(
      program,
      {"evaluate", "Measure error against run time of a method on given input, or what holds on extreme input.",
       "papilla evaluate tessellation data/cockpit.step -o evaluation"},
      [options](VerbContext& context) { return run(*options, context); });
  std::vector<std::string> names;
  std::string help = "What to measure:";
  for (const EvaluationKind& kind : evaluation_kinds()) {
    names.emplace_back(kind.name);
    help += fmt::format(" {} ({}),", kind.name, kind.summary);
  }
  names.emplace_back(k_stability);
  help += " stability (every method on input made to break it; takes no file)";
  verb->add_option("kind", options->evaluate.kind, help)->type_name("KIND")->transform(one_of(names))->required();
  reads(
      verb->add_option("file", options->evaluate.files,
                       "Files to read; without, inputs of its own: disks, solids, fractal surfaces, lattices, reliefs"))
      ->type_name("FILE");
  writes_into(
      verb->add_option("-o,--output", options->folder, "Folder for evaluate-KIND.json, .csv, .html and pictures"))
      ->type_name("DIR")
      ->required();
  verb->add_option("--repeats", options->evaluate.repeats,
                   "Measure this often when the time allows it; medians are drawn")
      ->check(in_range(1, 1000))
      ->capture_default_str();
  verb->add_option(
          "--seconds", options->seconds,
          fmt::format("Time for each file, {:g} when not given, {:g} for stability: nothing begins that is not "
                      "expected to end in time, and what is left out for it is named",
                      EvaluateOptions{}.seconds, k_stability_seconds))
      ->check(in_range(1e-3, 1e6));
  options->read.add_to(*verb);
}

}  // namespace papilla::app
