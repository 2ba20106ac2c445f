// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>

#include "papilla/pipeline/evaluate/built_in.hpp"
#include "evaluate/evaluation_files.hpp"
#include "evaluate/stability/stability_files.hpp"
#include "exit_code.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/machine.hpp"
#include "papilla/core/temporary_folder.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_stability = "stability";
constexpr double k_file_seconds = 60;

struct EvaluateOptions {
  std::string kind, folder;
  std::vector<std::string> files;
  SceneOptions read;
  int repeats = 3;
  std::optional<double> given_seconds;

  double seconds() const { return given_seconds.value_or(kind == k_stability ? k_stability_seconds : k_file_seconds); }
};

const EvaluationKind& kind_of(const std::string& name) {
  const auto kinds = evaluation_kinds();
  return *std::find_if(kinds.begin(), kinds.end(), [&](const EvaluationKind& kind) { return kind.name == name; });
}

/// Writes the files of an evaluation, and remembers their names. A folder that it made goes again when it stays empty.
class Folder {
 public:
  Folder(const std::string& path, const std::string& kind) : stem_(fs::path(path) / ("evaluate-" + kind)) {
    std::error_code error;
    is_new_ = fs::create_directories(path, error);
    if (!fs::is_directory(path)) throw IoError(path + ": cannot be made a folder");
  }
  ~Folder() {
    std::error_code not_empty;
    if (is_new_ && names_.empty()) fs::remove(stem_.parent_path(), not_empty);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  void write(const std::string& ending, const std::string& content) {
    const std::string name = stem_.string() + ending;
    write_atomically(name, content);
    names_.push_back(name);
  }
  void write(const std::string& ending, const Json& json) {
    write(ending, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  }
  const Json& names() const { return names_; }

 private:
  fs::path stem_;
  bool is_new_ = false;
  Json names_ = Json::array();
};

Json heading(const VerbContext& context, const EvaluateOptions& options) {
  const Machine machine = this_machine();
  return {{"kind", options.kind},
          {"version", version()},
          {"started", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
          {"machine",
           {{"cpu", machine.cpu},
            {"cores", machine.cores},
            {"memory_mib", machine.memory_mib},
            {"kernel", machine.kernel}}},
          {"options",
           {{"files", options.files},
            {"repeats", options.repeats},
            {"seconds", options.seconds()},
            {"threads", context.threads},
            {"seed", context.seed},
            {"chord_mm", options.read.chord_mm},
            {"angle_deg", options.read.angle_deg}}}};
}

std::string table_of(const std::vector<EvaluationRun>& runs) {
  std::string table;
  for (const EvaluationRun& run : runs) {
    table += fmt::format("{}, {}: {}{}\n", run.name(), run.input, run.error_name, run.valid ? "" : " (not valid)");
    for (const TraceSample& s : run.trace) table += fmt::format("  {:>10.4f} s  {:.6g}\n", s.seconds, s.error);
    if (run.trace.empty()) table += "  " + run.stop + "\n";
  }
  return table;
}

/// The file's own name, with its folder when another file is called the same.
std::string name_of(const std::string& file, const std::vector<std::string>& files) {
  const fs::path name = fs::path(file).filename();
  const auto alike = std::count_if(files.begin(), files.end(),
                                   [&](const std::string& other) { return fs::path(other).filename() == name; });
  return alike > 1 ? file : name.string();
}

Json evaluate_files(VerbContext& context, EvaluateOptions options) {
  std::optional<TemporaryFolder> own;
  if (options.files.empty())
    options.files = write_built_in_inputs(options.kind, own.emplace("papilla-evaluate").path());
  Folder folder(options.folder, options.kind);
  Json json = heading(context, options);
  std::vector<EvaluationRun> runs;
  for (const std::string& file : options.files) {
    std::vector<EvaluationRun> more =
        run_repeatedly(kind_of(options.kind),
                       {file, name_of(file, options.files), options.read, context.progress, Budget(options.seconds())},
                       options.repeats);
    std::move(more.begin(), more.end(), std::back_inserter(runs));
  }
  const std::vector<EvaluationGroup> groups = runs_groups(runs);
  const std::vector<EvaluationPicture> pictures = runs_pictures(groups);
  json["runs"] = runs_json(runs);
  json["pareto"] = Json::array();
  context.console.print(table_of(runs));
  for (const EvaluationGroup& group : groups) {
    json["pareto"].push_back({{"input", group.input}, {"error_name", group.error_name}, {"front", group.on_front}});
    context.console.print(fmt::format("on the Pareto front of {}, {}: {}\n", group.input, group.error_name,
                                      fmt::join(group.on_front, ", ")));
  }
  folder.write(".json", json);
  folder.write(".csv", runs_csv(runs));
  folder.write(".html", runs_html(options.kind, pictures, runs));
  for (std::size_t i = 0; i < pictures.size(); ++i) folder.write(fmt::format("-{}.svg", i + 1), pictures[i].svg);
  json["files"] = folder.names();
  return json;
}

Json evaluate_stability(VerbContext& context, const EvaluateOptions& options) {
  if (!options.files.empty()) throw UsageError("evaluate stability: has its own inputs and takes no FILE");
  Folder folder(options.folder, options.kind);
  Json json = heading(context, options);
  const StabilityTables tables = run_stability_suites(context.progress, Budget(options.seconds()));
  json["suites"] = stability_json(tables);
  context.console.print(stability_summary(tables));
  folder.write(".json", json);
  folder.write(".csv", stability_csv(tables));
  folder.write(".md", stability_markdown(tables));
  folder.write(".html", stability_html(tables));
  json["files"] = folder.names();
  return json;
}

}  // namespace

void add_evaluate(CLI::App& program) {
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* verb = add_verb(
      program,
      {"evaluate", "Measure error against run time of a method on given input, or what holds on extreme input.",
       "papilla evaluate tessellation data/cockpit.step -o evaluation"},
      [options](VerbContext& context) {
        return options->kind == k_stability ? evaluate_stability(context, *options) : evaluate_files(context, *options);
      });
  std::vector<std::string> names;
  std::string help = "What to measure:";
  for (const EvaluationKind& kind : evaluation_kinds()) {
    names.emplace_back(kind.name);
    help += fmt::format(" {} ({}),", kind.name, kind.summary);
  }
  names.emplace_back(k_stability);
  help += " stability (every method on input made to break it; takes no file)";
  verb->add_option("kind", options->kind, help)->type_name("KIND")->check(CLI::IsMember(names))->required();
  verb->add_option("file", options->files,
                   "Files to read; without, inputs of its own: disks, solids, fractal surfaces, lattices, reliefs")
      ->type_name("FILE");
  verb->add_option("-o,--output", options->folder, "Folder for evaluate-KIND.json, .csv, .html and pictures")
      ->type_name("DIR")
      ->required();
  verb->add_option("--repeats", options->repeats, "Measure this often when the time allows it; medians are drawn")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb->add_option(
          "--seconds", options->given_seconds,
          fmt::format("Time for each file, {:g} when not given, {:g} for stability: nothing begins that is not "
                      "expected to end in time, and what is left out for it is named",
                      k_file_seconds, k_stability_seconds))
      ->check(CLI::Range(1e-3, 1e6));
  options->read.add_to(*verb);
}

}  // namespace papilla::app
