// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "papilla/pipeline/scene_sides.hpp"

namespace papilla::app {

/// The options --inside and --keep-sides.
struct SideOption {
  std::string inside;
  bool keep = false;

  /// @param turns The verb turns sheets over; else it only counts them, and has no --keep-sides.
  void add_to(CLI::App& verb, bool turns = true);
  /// @param output The file that is written: only glTF says that a material has two sides. Empty: none.
  /// @throws UsageError naming the option when the point is not three finite numbers.
  SceneSideOptions options(const std::string& output = {}) const;
};

}  // namespace papilla::app
