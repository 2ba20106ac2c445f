// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "batch/run_batch.hpp"
#include "exit_code.hpp"
#include "file_options.hpp"
#include "option_checks.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/pipeline/shared_data.hpp"
#include "shown_format.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string folder;
  double chord_mm = 0.1;
};

/// The grains whose pictures the materials name as "grain/KIND.png".
std::set<std::string> grain_kinds(const std::string& materials) {
  std::set<std::string> kinds;
  const Json json = Json::parse(materials);
  for (const auto& [name, material] : json.at("materials").items())
    if (const fs::path texture = material.value("texture", ""); texture.parent_path() == "grain")
      kinds.insert(texture.stem().string());
  return kinds;
}

BatchLine line_of(std::vector<std::string> words) {
  BatchLine line;
  line.place = "demo";
  line.words = std::move(words);
  return line;
}

/// Runs commands of this program side by side, and prints each as a user would type it.
/// @throws SolverFailure at the time limit; the error of the command that failed.
void run_lines(const std::vector<BatchLine>& lines, int jobs, int threads, const VerbContext& context, Json& commands) {
  BatchOptions options;
  options.jobs = jobs;
  options.threads = std::max(1, threads / jobs);
  options.deadline = context.deadline;
  std::string failed;
  int exit_code = 0;
  const BatchResult result = run_batch(lines, options, [&](std::size_t i, const LineResult& one) {
    std::string text = "papilla";
    for (const std::string& word : lines[i].words) text += " " + word;
    if (one.state == LineResult::State::failed) {
      failed = one.messages.substr(one.messages.rfind('\n') + 1);
      if (failed.starts_with("papilla: ")) failed.erase(0, 9);
      exit_code = one.exit_code;
    } else {
      context.console.print(shown_format("{}  ({:.1f} s)\n", text, one.seconds));
    }
    commands.push_back({{"command", text}, {"seconds", one.seconds}});
  });
  if (result.signal != 0) {
    std::signal(result.signal, SIG_DFL);
    std::raise(result.signal);
  }
  if (result.timed_out) throw SolverFailure("demo: the time limit is over");
  if (exit_code == k_exit_solver) throw SolverFailure(failed);
  if (exit_code != 0) throw InvalidInput(failed);
}

Json run(const Options& options, VerbContext& context) {
  const fs::path folder = options.folder, data = find_shared_data("demo");
  const fs::path materials = folder / "materials.json", scene = folder / "cockpit.glb", report = folder / "report";
  const std::string text = read_file(data / "materials.json");
  make_folder(folder / "grain");
  write_atomically(materials, text);
  Json commands = Json::array();
  std::vector<BatchLine> grains;
  for (const std::string& kind : grain_kinds(text))
    grains.push_back(
        line_of({"synthesize", "grain", "--kind", kind, "-o", (folder / "grain" / (kind + ".png")).string()}));
  const int threads =
      context.threads > 0 ? context.threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  run_lines(grains, std::clamp(static_cast<int>(grains.size()), 1, threads), threads, context, commands);
  report_progress(context.progress, "demo", 0.1);
  run_lines({line_of({"bake", (data / "cockpit.step").string(), "-m", materials.string(), "-o", scene.string(),
                      "--chord", shown_format("{}", options.chord_mm), "--report", report.string(), "--pictures"})},
            1, threads, context, commands);
  context.console.print(
      shown_format("look at {}\n"
                   "feel it: papilla-player {} --device sim --seconds 2\n",
                   (report / "index.html").string(), scene.string()));
  return {{"commands", commands},
          {"scene", scene.string()},
          {"materials", materials.string()},
          {"report", (report / "index.html").string()}};
}

}  // namespace

void add_demo(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = add_verb(
      program,
      {"demo", "Makes grains and bakes the sample cockpit that is installed with the program.", "papilla demo -o demo"},
      [options](VerbContext& context) { return run(*options, context); });
  writes_into(verb->add_option("-o,--output", options->folder, "Folder for pictures, scene and report"),
              {"materials.json", "cockpit.glb"})
      ->type_name("DIR")
      ->required();
  verb->add_option("--chord", options->chord_mm, "Largest distance of triangles from the CAD surface, as of bake")
      ->type_name("MM")
      ->check(in_range(1e-6, 1e3))
      ->capture_default_str();
}

}  // namespace papilla::app
