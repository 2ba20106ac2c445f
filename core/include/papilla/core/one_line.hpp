// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace papilla {

/// A text of one line, as messages and line-based files need it: control characters become blanks.
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

}  // namespace papilla
