// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <string>

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

}  // namespace papilla::app
