// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "papilla/pipeline/perception.hpp"

namespace papilla::app {

/// The options --reach, --view, --view-samples and --leave-out.
struct PerceptionOption {
  std::string reach, view;             ///< A volume as numbers, JSON, or the name of a JSON file; empty: not asked.
  std::vector<std::string> leave_out;  ///< "unreachable", "unseen", or both.
  std::uint32_t samples = 1000;

  void add_to(CLI::App& verb, bool can_leave_out = true);
  /// @throws UsageError naming the option; IoError, InvalidInput naming a volume's file and JSON pointer.
  PerceptionOptions options() const;
};

}  // namespace papilla::app
