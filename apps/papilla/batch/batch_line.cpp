// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/batch_line.hpp"

#include <sys/stat.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "command_line.hpp"
#include "exit_code.hpp"
#include "file_options.hpp"
#include "json/json.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/near_name.hpp"
#include "papilla/core/read_file.hpp"
#include "parsing_only.hpp"
#include "shown_format.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

constexpr const char *k_program = "papilla", *k_batch = "batch";

std::vector<std::string> command_of(const Json& line) {
  const auto found = line.find("command");
  if (found == line.end()) throw InvalidInput("has no \"command\"");
  if (!found->is_array() || found->size() < 2 ||
      !std::all_of(found->begin(), found->end(), [](const Json& word) { return word.is_string(); }))
    throw InvalidInput("\"command\" must be a list of texts, [\"papilla\", \"VERB\", ...]");
  auto words = found->get<std::vector<std::string>>();
  for (const std::string& word : words)
    if (word.find('\0') != std::string::npos) throw InvalidInput("\"command\": a text has the character 0");
  if (fs::path(words.front()).filename() != k_program)
    throw InvalidInput("\"command\" begins with '" + words.front() + "' instead of 'papilla'");
  words.erase(words.begin());
  return words;
}

BatchLine line_of(const Json& json) {
  if (!json.is_object()) throw InvalidInput("must be an object");
  BatchLine line;
  line.words = command_of(json);
  if (const auto id = json.find("id"); id != json.end()) {
    if (!id->is_string()) throw InvalidInput("\"id\" must be a text");
    line.id = id->get<std::string>();
  }
  if (const auto cost = json.find("cost_seconds"); cost != json.end()) {
    if (!cost->is_number() || !(cost->get<double>() >= 0)) throw InvalidInput("\"cost_seconds\" must be 0 or more");
    line.cost_seconds = cost->get<double>();
  }
  return line;
}

/// A word with the names in braces replaced.
std::string filled(const std::string& word, const fs::path& input) {
  const std::map<std::string, std::string, std::less<>> values = {
      {"{stem}", input.stem().string()},
      {"{name}", input.filename().string()},
      {"{folder}", input.has_parent_path() ? input.parent_path().string() : "."}};
  constexpr std::string_view k_letters = "abcdefghijklmnopqrstuvwxyz";
  std::string result;
  std::size_t at = 0;
  for (std::size_t open = 0; (open = word.find('{', open)) != std::string::npos;) {
    const std::size_t close = word.find_first_not_of(k_letters, open + 1);
    if (close == std::string::npos || close == open + 1 || word[close] != '}') {
      ++open;  // Braces of something else, like JSON.
      continue;
    }
    const std::string name = word.substr(open, close + 1 - open);
    const auto value = values.find(name);
    if (value == values.end())
      throw UsageError("'" + word + "': " + name + " is none of {folder}, {name}, {stem}" +
                       did_you_mean(name, {"{folder}", "{name}", "{stem}"}));
    result.append(word, at, open - at).append(value->second);
    open = at = close + 1;
  }
  return result.append(word, at);
}

/// The program's command line, which does nothing when it is parsed.
class DryProgram {
 public:
  DryProgram() : program_("", k_program) {
    program_.require_subcommand(1);
    add_verbs(program_);
  }

  /// @throws InvalidInput, IoError saying what is wrong with the words.
  const CLI::App& parsed(std::vector<std::string> words) {
    const ParsingOnly parsing_only;
    std::reverse(words.begin(), words.end());  // As CLI11 wants them.
    try {
      program_.parse(words);
    } catch (const CLI::ParseError& error) {
      throw InvalidInput(error.get_exit_code() == 0 ? "asks for help and does nothing"
                                                    : parse_error_text(program_, error));
    }
    const CLI::App& verb = *program_.get_subcommands().front();
    if (verb.get_name() == k_batch) throw InvalidInput("a batch can't run another one");
    return verb;
  }

 private:
  CLI::App program_;
};

/// Tells files apart: by device and inode, or by the path of one that is not there.
std::string identity(const fs::path& path) {
  struct stat about {};
  if (::stat(path.c_str(), &about) == 0) return std::to_string(about.st_dev) + ":" + std::to_string(about.st_ino);
  std::error_code error;
  const fs::path file = fs::weakly_canonical(fs::absolute(path, error), error);
  return (error ? path : file).string();
}

bool is_device(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

/// @param folders  that the verb fills with files of names that only it knows.
void find_files(const CLI::App& verb, BatchLine& line, std::vector<fs::path>& folders) {
  for (const CLI::Option* option : verb.get_options()) {
    const auto known = file_options().find(option);
    if (known == file_options().end()) continue;
    const auto& [use, names] = known->second;
    for (const std::string& value : option->results()) {
      if (value.empty() || value == "-" || is_device(value)) continue;
      if (use == FileOption::Use::input) line.inputs.emplace_back(value);
      if (names_output(use, value)) line.outputs.emplace_back(value);
      if (use == FileOption::Use::folder && names.empty()) folders.emplace_back(value);
      for (const std::string& name : names) line.outputs.push_back(fs::path(value) / name);
    }
  }
}

struct Written {
  const BatchLine* line = nullptr;
  fs::path path;
};

void require_one_writer(std::map<std::string, Written>& written, const fs::path& path, const BatchLine& line) {
  const auto [known, is_new] = written.try_emplace(identity(path), Written{&line, path});
  if (!is_new)
    throw OverwriteRefused(shown_format("{}: {} is the same file as {} of {}, which is written too", line.place,
                                        path.string(), known->second.path.string(), known->second.line->place));
}

}  // namespace

std::vector<BatchLine> manifest_lines(const fs::path& manifest) {
  std::istringstream text(read_file(manifest));
  std::vector<BatchLine> lines;
  std::string content;
  for (int number = 1; std::getline(text, content); ++number) {
    if (content.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::string place = shown_format("{}: line {}", manifest.string(), number);
    try {
      lines.push_back(line_of(Json::parse(content)));
    } catch (const Json::parse_error& error) {
      throw InvalidInput(shown_format("{}: byte {} is no JSON", place, error.byte));
    } catch (const InvalidInput& error) {
      throw InvalidInput(place + ": " + error.what());
    }
    lines.back().place = place;
  }
  return lines;
}

std::vector<BatchLine> lines_of_verb(const std::string& verb, std::span<const std::string> inputs,
                                     std::span<const std::string> words) {
  std::vector<BatchLine> lines;
  for (const std::string& input : inputs) {
    BatchLine& line = lines.emplace_back();
    line.place = input;
    line.words = {verb, input};
    for (const std::string& word : words) line.words.push_back(filled(word, input));
  }
  return lines;
}

void check_lines(std::span<BatchLine> lines) {
  DryProgram program;
  std::map<std::string, Written> written;
  for (BatchLine& line : lines) try {
      const CLI::App& verb = program.parsed(line.words);
      std::vector<fs::path> folders;
      find_files(verb, line, folders);
      line.names_threads = !verb.get_option("--threads")->empty();
      for (const auto* paths : {&line.outputs, &folders})
        for (const fs::path& path : *paths) require_one_writer(written, path, line);
    } catch (const InvalidInput& error) {
      throw InvalidInput(line.place + ": " + error.what());
    } catch (const IoError& error) {
      throw IoError(line.place + ": " + error.what());
    }
  for (const BatchLine& line : lines)
    for (const fs::path& path : line.inputs)
      if (const auto found = written.find(identity(path)); found != written.end())
        throw OverwriteRefused(shown_format("{}: would be written over {} of {}, which is read",
                                            found->second.line->place + ": " + found->second.path.string(),
                                            path.string(), line.place));
}

bool is_up_to_date(const BatchLine& line) {
  std::error_code error;
  fs::file_time_type oldest = fs::file_time_type::max();
  for (const fs::path& path : line.outputs) {
    oldest = std::min(oldest, fs::last_write_time(path, error));
    if (error) return false;
  }
  for (const fs::path& path : line.inputs) {
    const fs::file_time_type time = fs::last_write_time(path, error);
    if (error || time > oldest) return false;
  }
  return !line.outputs.empty();
}

}  // namespace papilla::app
