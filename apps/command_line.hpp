// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>

#include "exit_code.hpp"
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

/// Prints what CLI11 throws in place of a result, help included. @returns the exit code.
/// @throws IoError as print_out().
inline int report_parse_error(const CLI::App& program, const CLI::ParseError& error) {
  std::ostringstream out, complaint;
  const bool is_wrong = program.exit(error, out, complaint) != 0;
  print_out(out.str());
  // Only the message has what was typed: its line feeds are no ends of lines.
  std::string text = complaint.str();
  const std::string message = error.what();
  if (text.starts_with(message)) text = shown(message) + text.substr(message.size());
  std::fputs(shown_lines(text).c_str(), stderr);
  return is_wrong ? k_exit_usage : k_exit_done;
}

}  // namespace papilla::app
