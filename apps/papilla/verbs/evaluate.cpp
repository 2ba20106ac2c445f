// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <ctime>
#include <memory>
#include <optional>
#include <string_view>

#include "evaluate/evaluation_files.hpp"
#include "evaluate/param_table.hpp"
#include "exit_code.hpp"
#include "file_options.hpp"
#include "json/evaluation_json.hpp"
#include "option_checks.hpp"
#include "options/scene_option.hpp"
#include "papilla/pipeline/measure_scene.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

constexpr const char* k_stability = "stability";
constexpr const char* k_param = "param";

struct Options {
  EvaluateOptions evaluate;
  std::string folder;
  SceneOptions read;
  std::optional<double> seconds;
  const CLI::App* verb = nullptr;
};

/// A word as a shell takes it.
std::string quoted(const std::string& word) {
  const bool is_plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("-_./,:=+@").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (is_plain) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// The command line, without where results go and what all verbs have: what the results depend on.
std::string command_of(const CLI::App& verb) {
  std::string text = "papilla " + verb.get_name();
  for (const bool positional : {true, false})
    for (const CLI::Option* option : verb.get_options()) {
      if (option->empty() || option->get_positional() != positional || option->check_name("--output")) continue;
      if (!positional && option->get_group() == "Common") continue;
      if (!positional) text += " --" + option->get_lnames().front();
      for (const std::string& word : option->results()) text += " " + quoted(word);
    }
  return text;
}

void write_param_table(Json& json, const Evaluation& evaluation, EvaluationFolder& folder, const Options& options) {
  const ParamComparison& comparison = options.evaluate.param;
  const std::string command = command_of(*options.verb);
  json["table"] = {{"command", command}, {"rows", param_rows_json(evaluation.runs, comparison)}};
  folder.write("-table.csv", param_csv(evaluation.runs, comparison));
  folder.write("-table.tex", param_latex(evaluation.runs, comparison, command));
}

Json write_stability(Json json, EvaluationFolder& folder, const EvaluateOptions& options, const Options&,
                     VerbContext& context) {
  const std::vector<StabilitySuite> suites = evaluate_stability(options.seconds, context.progress);
  json["suites"] = stability_json(suites);
  context.console.print(stability_summary(suites));
  folder.write(".json", json_text(json));
  folder.write(".csv", stability_csv(suites));
  folder.write(".md", stability_markdown(suites));
  folder.write(".html", stability_html(suites));
  return json;
}

Json write_runs(Json json, EvaluationFolder& folder, const EvaluateOptions& options, const Options& given,
                VerbContext& context) {
  const Evaluation evaluation = evaluate(options, context.progress);
  const std::vector<EvaluationGroup> groups = group_runs(evaluation.runs);
  const std::vector<EvaluationPicture> pictures = runs_pictures(groups);
  json["options"]["files"] = evaluation.files;
  json["runs"] = runs_json(evaluation.runs);
  json["pareto"] = pareto_json(groups);
  context.console.print(runs_summary(evaluation.runs, groups));
  if (options.kind == k_param) write_param_table(json, evaluation, folder, given);
  folder.write(".json", json_text(json));
  folder.write(".csv", runs_csv(evaluation.runs));
  folder.write(".html", runs_html(options.kind, pictures, evaluation.runs));
  for (std::size_t i = 0; i < pictures.size(); ++i) folder.write(fmt::format("-{}.svg", i + 1), pictures[i].svg);
  return json;
}

/// What only `param` takes, and what does not go together there.
void check_param(const Options& options) {
  const ParamComparison& param = options.evaluate.param;
  for (const char* name : {"--method", "--charts", "--normalize"})
    if (!options.verb->get_option(name)->empty() && options.evaluate.kind != k_param)
      throw UsageError(std::string(name) + " is for evaluate param only");
  if (param.charts != ChartSource::automatic && param.methods == std::vector{UnwrapMethod::environment})
    throw UsageError("--charts " + chart_source_name(param.charts) + ": environment maps no charts");
}

Json run(const Options& options, VerbContext& context) {
  EvaluateOptions evaluation = options.evaluate;
  const bool is_stability = evaluation.kind == k_stability;
  if (is_stability && !evaluation.files.empty())
    throw UsageError("evaluate stability: has its own inputs and takes no FILE");
  check_param(options);
  evaluation.read = options.read.read_options(nullptr);
  evaluation.seconds = options.seconds.value_or(is_stability ? k_stability_seconds : evaluation.seconds);
  EvaluationFolder folder(options.folder, evaluation.kind);
  Json json = evaluation_json(evaluation, std::time(nullptr), context.threads, context.seed);
  json = (is_stability ? write_stability : write_runs)(std::move(json), folder, evaluation, options, context);
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
  writes_into(verb->add_option(
                  "-o,--output", options->folder,
                  "Folder for evaluate-KIND.json, .csv, .html and pictures; of param also a table as .csv and .tex"))
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
  std::vector<std::string> methods;
  for (const auto& method : unwrap_methods()) methods.push_back(method.first);
  verb->add_option_function<std::vector<std::string>>(
          "--method",
          [&chosen = options->evaluate.param.methods](const std::vector<std::string>& given) {
            for (const std::string& name : given) chosen.push_back(unwrap_methods().at(name));
          },
          "Of param: these methods only; default: all")
      ->transform(one_of(methods))
      ->delimiter(',')
      ->type_name("NAME");
  add_choice<ChartSource>(*verb, "--charts", options->evaluate.param.charts, chart_sources(),
                          "Of param: auto (default): one chart, the largest part or its largest chart; keep: each "
                          "component of the part; uv: the charts of the file's own texture coordinates");
  add_choice<UvNormalization>(*verb, "--normalize", options->evaluate.param.normalize, uv_normalizations(),
                              "Of param: what shares a factor that makes areas in uv those in space, as in measure");
  options->verb = verb;
  options->read.add_to(*verb);
}

}  // namespace papilla::app
