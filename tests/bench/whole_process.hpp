// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace papilla::bench {

struct ProcessCost {
  double seconds = 0, cpu_seconds = 0;
  std::size_t peak_bytes = 0;
};

/// Runs a program, found along PATH, to its end with its output thrown away.
/// @throws IoError when it can't be started or ends with another status than 0.
ProcessCost run_process(const std::vector<std::string>& command);

/// Is there such a program along PATH?
bool has_program(const std::string& name);

}  // namespace papilla::bench
