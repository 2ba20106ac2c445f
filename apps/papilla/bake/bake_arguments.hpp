// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "options/output_option.hpp"
#include "options/perception_option.hpp"
#include "options/scene_option.hpp"
#include "options/side_option.hpp"
#include "options/touch_option.hpp"
#include "papilla/pipeline/bake_file.hpp"
#include "verb.hpp"

namespace papilla::app {

/// All that shapes the result of a bake; of bake and split.
struct BakeArguments {
  std::string input, materials, material_library;
  std::vector<std::string> libraries, mirrors;
  BakeFileOptions bake;
  PerceptionOption perception;
  SideOption sides;
  SceneOptions scene;
  OutputOptions stored;

  void add_to(CLI::App& verb);
  Materials rules() const;
  /// @param output the file to be written, for what its format can hold.
  BakeFileOptions options(const std::filesystem::path& output, const VerbContext& context) const;
};

/// Where a bake's result goes, and what is said of it; of bake and merge.
struct BakeOutputs {
  std::string output, report, environment;
  bool pictures = false;
  TouchOptions touch;

  void add_to(CLI::App& verb);
};

/// Bakes, writes and reports.
/// @param wanted BakeArguments::options(), perhaps with another cache.
Json write_bake(const BakeArguments& arguments, const BakeOutputs& outputs, BakeFileOptions wanted,
                VerbContext& context);

}  // namespace papilla::app
