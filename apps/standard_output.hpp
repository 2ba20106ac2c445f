// SPDX-License-Identifier: MIT
#pragma once

#include <cerrno>
#include <cstdio>
#include <string>
#include <string_view>
#include <system_error>

#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"

namespace papilla::app {

/// Writes text, for people or programs, to standard output at once: whoever waits at the other end of a pipe gets it
/// now. What could steer a terminal is escaped.
/// @throws IoError with the system's reason.
inline void print_out(std::string_view text) {
  const std::string safe = shown_lines(text);
  errno = 0;
  if (std::fwrite(safe.data(), 1, safe.size(), stdout) == safe.size() && std::fflush(stdout) == 0) return;
  throw IoError("standard output: " + std::generic_category().message(errno));
}

}  // namespace papilla::app
