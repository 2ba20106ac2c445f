// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "exit_code.hpp"
#include "papilla/core/near_name.hpp"
#include "papilla/core/one_line.hpp"
#include "standard_output.hpp"

namespace papilla::app {

/// Refuses "nan" as the value of any option that was given: comparisons with a range let it through.
/// @throws CLI::ValidationError.
inline void refuse_no_numbers(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options())
    for (const std::string& value : option->results()) {
      char* end = nullptr;
      const double number = std::strtod(value.c_str(), &end);
      if (!value.empty() && *end == '\0' && std::isnan(number))
        throw CLI::ValidationError(option->get_name(), value + " is no number");
    }
  for (const CLI::App* verb : app.get_subcommands()) refuse_no_numbers(*verb);
}

/// Whether the command line asks for the machine-readable result on standard output, right or wrong as it may be.
inline bool wants_json_on_stdout(int argc, char** argv) {
  const std::vector<std::string_view> words(argv, argv + argc);
  const auto json = std::find(words.begin(), words.end(), "--json");
  return (json != words.end() && json + 1 != words.end() && json[1] == "-") ||
         std::find(words.begin(), words.end(), "--json=-") != words.end();
}

/// Names the first word of the command line that is no verb, no option and no value, with what may be meant; empty
/// when there is none.
inline std::string unknown_word(const CLI::App& program) {
  const CLI::App* verb = &program;
  while (!verb->get_subcommands().empty()) verb = verb->get_subcommands().front();
  std::vector<std::string> words = verb->remaining();
  std::erase(words, "--");  // CLI11 lists it, too; it is no word.
  if (words.empty()) return "";
  std::string word = words.front();
  if (word.starts_with("-")) word.resize(std::min(word.size(), word.find('=')));  // An option's value.
  const std::string place = verb == &program ? "" : verb->get_name() + ": ";
  std::vector<std::string> known;
  if (word.starts_with("-")) {
    for (const CLI::Option* option : verb->get_options())
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    std::string hint = did_you_mean(word, {known.begin(), known.end()});
    if (hint.empty() && verb->get_option_no_throw("options"))  // It hands on what stands there.
      hint = "; options of the verb that runs for each input go behind --";
    return place + "unknown option '" + word + "'" + hint;
  }
  for (const CLI::App* other : verb->get_subcommands({})) known.push_back(other->get_name());
  if (known.empty()) return place + "unexpected word '" + word + "'";
  // They are few: the nearest one helps even when it is far.
  return "unknown verb '" + word + "'" + did_you_mean(word, {known.begin(), known.end()}, word.size());
}

/// What is wrong with a command line, for people.
inline std::string parse_error_text(const CLI::App& program, const CLI::ParseError& error) {
  std::string message = unknown_word(program);
  return message.empty() ? error.what() : message;
}

/// Prints what CLI11 throws in place of a result, help included. @returns the exit code.
/// @param as_json An error is printed as JSON, too. @throws IoError as print_out().
inline int report_parse_error(const CLI::App& program, const CLI::ParseError& error, bool as_json) {
  std::ostringstream out, complaint;
  const bool is_wrong = program.exit(error, out, complaint) != 0;
  print_out(out.str());
  if (!is_wrong) return k_exit_done;
  const std::string message = parse_error_text(program, error);
  // The rest says how to get help.
  std::string text = complaint.str();
  if (text.starts_with(error.what())) text = text.substr(std::string_view(error.what()).size());
  if (as_json) print_failure_json({message, k_exit_usage});
  // Only the message has what was typed: its line feeds are no ends of lines.
  std::fputs((shown(message) + shown_lines(text)).c_str(), stderr);
  return k_exit_usage;
}

}  // namespace papilla::app
