// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "batch/batch_line.hpp"
#include "batch/run_batch.hpp"
#include "exit_code.hpp"
#include "file_options.hpp"
#include "option_checks.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"
#include "shown_format.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

using State = LineResult::State;

constexpr std::array k_states{"not run", "done", "skipped", "failed", "ended"};  ///< In the order of State.

const char* name_of(State state) { return k_states[static_cast<std::size_t>(state)]; }

struct Options {
  std::string what;
  std::vector<std::string> inputs;  ///< And from the first that begins with - on options of the verb.
  std::string no_input;             ///< CLI11 takes -- only while a positional is open, which this one stays.
  int jobs = 0;
  bool skip_existing = false, keep_going = false;
  const CLI::App* program = nullptr;
};

bool is_verb(const Options& options) {
  const auto verbs = options.program->get_subcommands([](const CLI::App*) { return true; });
  return std::any_of(verbs.begin(), verbs.end(), [&](const auto* verb) { return verb->get_name() == options.what; });
}

std::vector<BatchLine> lines_of(const Options& options) {
  if (!is_verb(options)) {
    if (!options.inputs.empty())
      throw UsageError("batch: '" + options.what + "' is no verb, and a manifest goes alone: '" +
                       options.inputs.front() + "' is one too many");
    return manifest_lines(options.what);
  }
  const auto first_option = std::find_if(options.inputs.begin(), options.inputs.end(),
                                         [](const std::string& word) { return word.starts_with("-"); });
  if (first_option == options.inputs.begin()) throw UsageError("batch " + options.what + ": no input is named");
  return lines_of_verb(options.what, {options.inputs.begin(), first_option}, {first_option, options.inputs.end()});
}

/// The folders of a verb's outputs, which are named once for all inputs; those of a manifest are its maker's affair.
void make_output_folders(const std::vector<BatchLine>& lines) {
  for (const BatchLine& line : lines)
    for (const std::filesystem::path& output : line.outputs)
      if (output.has_parent_path()) make_folder(output.parent_path());
}

/// Wrong words on the command line are its own, those of a file are input.
std::vector<BatchLine> checked_lines(const Options& options) {
  std::vector<BatchLine> lines = lines_of(options);
  try {
    check_lines(lines);
  } catch (const InvalidInput& error) {
    if (is_verb(options)) throw UsageError(error.what());
    throw;
  }
  return lines;
}

std::string command_text(const BatchLine& line) {
  std::string text;
  for (const std::string& word : line.words) text += (text.empty() ? "" : " ") + word;
  return text;
}

void print_line(const BatchLine& line, const LineResult& result, const Console& console) {
  console.print(shown_format("{:<8} {:>9.1f} s  {}\n", name_of(result.state), result.seconds, command_text(line)));
  if (result.state != State::failed) return;
  const std::string last = result.messages.substr(result.messages.rfind('\n') + 1);
  std::fputs(shown_format("papilla: {}: exit code {}: {}\n", line.place, result.exit_code, last).c_str(), stderr);
}

Json line_json(const BatchLine& line, const LineResult& result) {
  Json json = {{"place", line.place}};
  if (!line.id.empty()) json["id"] = line.id;
  json["command"] = Json::array({"papilla"});
  for (const std::string& word : line.words) json["command"].push_back(word);
  json["state"] = name_of(result.state);
  if (result.state == State::skipped || result.state == State::not_run) return json;
  json["exit_code"] = result.exit_code;
  json["seconds"] = result.seconds;
  json["cpu_seconds"] = result.cpu_seconds;
  json["peak_mib"] = result.peak_mib;
  if (!result.messages.empty()) json["messages"] = result.messages;
  return json;
}

/// Of the worst line; without one that failed, 4 when the time limit left some.
int exit_code_of(const BatchResult& result) {
  int worst = k_exit_done;
  for (const LineResult& line : result.lines)
    if (line.state == State::failed) worst = std::max(worst, line.exit_code);
  return worst == k_exit_done && result.timed_out ? k_exit_solver : worst;
}

[[noreturn]] void end_by(int signal) {
  std::signal(signal, SIG_DFL);
  std::raise(signal);
  std::abort();
}

Json run(const Options& options, VerbContext& context) {
  const std::vector<BatchLine> lines = checked_lines(options);
  const int cores =
      context.threads > 0 ? context.threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  BatchOptions wanted;
  wanted.jobs = options.jobs > 0 ? options.jobs : cores;
  wanted.threads = std::max(1, cores / wanted.jobs);
  wanted.skip_existing = options.skip_existing;
  wanted.keep_going = options.keep_going;
  wanted.deadline = context.deadline;
  if (is_verb(options)) make_output_folders(lines);
  const Stopwatch clock;
  std::size_t ended = 0;
  const BatchResult result = run_batch(lines, wanted, [&](std::size_t line, const LineResult& one) {
    print_line(lines[line], one, context.console);
    report_progress(context.progress, "batch", static_cast<double>(++ended) / static_cast<double>(lines.size()));
  });
  Json json = {{"lines", lines.size()}};
  std::string counts;
  for (const State state : {State::done, State::skipped, State::failed, State::ended, State::not_run}) {
    const auto count = std::count_if(result.lines.begin(), result.lines.end(),
                                     [state](const LineResult& line) { return line.state == state; });
    json[state == State::not_run ? "not_run" : name_of(state)] = count;
    if (count > 0) counts += shown_format("{}{} {}", counts.empty() ? "" : ", ", count, name_of(state));
  }
  context.console.print(shown_format("{} lines in {:.1f} s: {}\n", lines.size(), clock.seconds(), counts));
  if (result.signal != 0) end_by(result.signal);
  context.exit_code = exit_code_of(result);
  json["jobs"] = wanted.jobs;
  json["threads"] = wanted.threads;
  json["seconds"] = clock.seconds();
  json["results"] = Json::array();
  for (std::size_t i = 0; i < lines.size(); ++i) json["results"].push_back(line_json(lines[i], result.lines[i]));
  return json;
}

}  // namespace

void add_batch(CLI::App& program) {
  auto options = std::make_shared<Options>();
  options->program = &program;
  CLI::App* verb = add_verb(
      program,
      {"batch", "Runs a verb for many inputs, or the lines of a manifest, side by side.",
       "papilla batch repair data/exchange/*.stl --skip-existing -- -o '{stem}.glb'", VerbInfo::AtDeadline::ends},
      [options](VerbContext& context) { return run(*options, context); });
  reads(verb->add_option("what", options->what,
                         "A verb; or a file of JSON Lines, each an object with \"command\": [\"papilla\", ...], like "
                         "that of papilla split"))
      ->type_name("VERB|MANIFEST")
      ->required();
  reads(verb->add_option("inputs", options->inputs, "Inputs of the verb"))->type_name("IN");
  verb->add_option("options", options->no_input,
                   "Behind --, options of the verb for each input, where {stem} stands for its name without extension, "
                   "{name} for the whole and {folder} for its folder")
      ->type_name("-- OPTION ...");
  verb->add_option("-j,--jobs", options->jobs,
                   "Lines that run side by side, each with its share of --threads; 0: as many as threads")
      ->type_name("N")
      ->check(in_range(0, 1024))
      ->capture_default_str();
  verb->add_flag("--skip-existing", options->skip_existing,
                 "Skip lines whose output files are all there and not older than the files that their options read");
  verb->add_flag("-k,--keep-going", options->keep_going, "Begin the other lines after one has failed");
}

}  // namespace papilla::app
