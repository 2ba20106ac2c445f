// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "papilla/core/near_name.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/plain_number.hpp"

/// Checks of the values of options, with messages for people. Help shows them behind the option; completion reads the
/// choices there.
namespace papilla::app {

inline std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// The value is one of the choices, upper and lower case alike; used with transform() it gets the choice's spelling.
inline CLI::Validator one_of(std::vector<std::string> choices) {
  std::string list;
  for (const std::string& choice : choices) list += (list.empty() ? "" : ",") + choice;
  return {[choices = std::move(choices), list](std::string& value) -> std::string {
            for (const std::string& choice : choices)
              if (lower_case(choice) == lower_case(value)) {
                value = choice;
                return "";
              }
            return "'" + shown(value) + "' is none of " + list +
                   did_you_mean(value, std::vector<std::string_view>(choices.begin(), choices.end()));
          },
          "{" + list + "}", "one of"};
}

/// A check whose message is "VALUE is not RANGE".
template <class IsIn>
CLI::Validator number_check(IsIn is_in, const std::string& range, const std::string& shown_range) {
  return {[is_in, range](std::string& text) -> std::string {
            double value = 0;
            if (!CLI::detail::lexical_cast(text, value)) return "'" + shown(text) + "' is no number";
            return is_in(value) ? "" : shown(text) + " is not " + range;
          },
          shown_range, "number"};
}

inline CLI::Validator in_range(double low, double high) {
  const std::string range = plain_number(low) + " to " + plain_number(high);
  return number_check([low, high](double value) { return value >= low && value <= high; }, "from " + range, range);
}

inline CLI::Validator positive() {
  return number_check([](double value) { return value > 0 && value <= std::numeric_limits<double>::max(); }, "above 0",
                      "above 0");
}

inline CLI::Validator not_negative() {
  return number_check([](double value) { return value >= 0 && value <= std::numeric_limits<double>::max(); },
                      "0 or more", "0 or more");
}

/// An option whose value has a name.
template <class Value>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Value& value, std::map<std::string, Value> choices,
                        const std::string& help) {
  std::vector<std::string> names;
  for (const auto& choice : choices) names.push_back(choice.first);
  return app
      .add_option_function<std::string>(
          name, [&value, choices = std::move(choices)](const std::string& given) { value = choices.at(given); }, help)
      ->transform(one_of(std::move(names)))
      ->type_name("NAME");
}

}  // namespace papilla::app
