// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "papilla/io/scene_file.hpp"

namespace papilla::app {

/// How a verb's input is read: unit, axes and, for CAD, tessellation. Shared by every verb that reads a scene.
struct SceneOptions {
  std::string unit = "file", up = "file", quality, tags;
  double chord_mm = 0.1, angle_deg = 20, max_edge_mm = 0;

  void add_to(CLI::App& verb);
  /// @param cache  of the verb (VerbContext), for CAD files.
  ReadOptions read_options(const StageCache* cache) const;
};

}  // namespace papilla::app
