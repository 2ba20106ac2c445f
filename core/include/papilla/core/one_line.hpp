// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace papilla {

/// A text of one line, as line-based files need it: control characters become blanks.
inline std::string one_line(std::string_view text) {
  std::string line(text);
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c >= 0 && c < ' '; }, ' ');
  return line;
}

/// The text up to the first line break.
inline std::string first_line(std::string_view text) { return std::string(text.substr(0, text.find('\n'))); }

/// The first `most` characters of a text as messages quote it: printable ASCII, the rest as '?'.
inline std::string printable(std::string_view text, std::size_t most = 40) {
  std::string quoted(text.substr(0, most));
  std::replace_if(
      quoted.begin(), quoted.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return quoted;
}

/// A name that comes from a file, as people see it on one line. What could steer a terminal or change the order of
/// characters is escaped as in JSON: the control characters U+0000 to U+001F and U+007F to U+009F, the separators
/// U+2028 and U+2029, and the marks of direction U+061C, U+200E, U+200F, U+202A to U+202E, U+2066 to U+2069 become \n,
/// \t, \r or \u202e; a byte that is not UTF-8 becomes \x9b. Everything else stays.
std::string shown(std::string_view name);

/// The same of a text of several lines: line feeds stay. JSON text stays JSON of the same value.
std::string shown_lines(std::string_view text);

}  // namespace papilla
