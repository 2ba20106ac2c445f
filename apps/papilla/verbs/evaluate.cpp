// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

struct EvaluateOptions {
  std::string kind, folder;
  std::vector<std::string> files;
  SceneOptions read;
};

const EvaluationKind& kind_of(const std::string& name) {
  const auto kinds = evaluation_kinds();
  return *std::find_if(kinds.begin(), kinds.end(), [&](const EvaluationKind& kind) { return kind.name == name; });
}

std::string table_of(const std::vector<EvaluationRun>& runs) {
  std::string table;
  for (const EvaluationRun& run : runs) {
    table += fmt::format("{}, {}: {}\n", run_name(run), run.input, run.error_name);
    for (const TraceSample& s : run.trace) table += fmt::format("  {:>10.4f} s  {:.6g}\n", s.seconds, s.error);
  }
  return table;
}

Json evaluate(VerbContext& context, const EvaluateOptions& options) {
  const fs::path folder = options.folder;
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder)) throw IoError(options.folder + ": cannot be made a folder");
  std::vector<EvaluationRun> runs;
  for (const std::string& file : options.files) {
    std::vector<EvaluationRun> more = kind_of(options.kind).run({file, options.read, context.progress});
    std::move(more.begin(), more.end(), std::back_inserter(runs));
  }
  const std::string name = "evaluate-" + options.kind;
  Json json = {{"kind", options.kind}, {"runs", runs_json(runs)}};
  write_atomically(folder / (name + ".json"), json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  write_atomically(folder / (name + ".csv"), runs_csv(runs));
  const std::vector<EvaluationPicture> pictures = runs_pictures(runs);
  write_atomically(folder / (name + ".html"), runs_html(options.kind, pictures, runs));
  context.console.print(table_of(runs));
  json["files"] = {(folder / (name + ".json")).string(), (folder / (name + ".csv")).string(),
                   (folder / (name + ".html")).string()};
  json["pareto"] = Json::array();
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const fs::path file = folder / fmt::format("{}-{}.svg", name, i + 1);
    write_atomically(file, pictures[i].svg);
    json["files"].push_back(file.string());
    json["pareto"].push_back({{"title", pictures[i].title}, {"front", pictures[i].front}});
    context.console.print(
        fmt::format("on the Pareto front of {}: {}\n", pictures[i].title, fmt::join(pictures[i].front, ", ")));
  }
  return json;
}

}  // namespace

void add_evaluate(CLI::App& program) {
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* verb = add_verb(program,
                            {"evaluate", "Measure error against run time of a method on given input.",
                             "papilla evaluate tessellation data/cockpit.step -o evaluation"},
                            [options](VerbContext& context) { return evaluate(context, *options); });
  std::vector<std::string> names;
  std::string help = "What to measure:";
  for (const EvaluationKind& kind : evaluation_kinds()) {
    names.emplace_back(kind.name);
    help += fmt::format(" {} ({}){}", kind.name, kind.summary, &kind == &evaluation_kinds().back() ? "" : ",");
  }
  verb->add_option("kind", options->kind, help)->type_name("KIND")->check(CLI::IsMember(names))->required();
  verb->add_option("file", options->files, "Files to read")->type_name("FILE")->required();
  verb->add_option("-o,--output", options->folder, "Folder for evaluate-KIND.json, .csv, .html and pictures")
      ->type_name("DIR")
      ->required();
  options->read.add_to(*verb);
}

}  // namespace papilla::app
