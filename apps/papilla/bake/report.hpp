// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "papilla/pipeline/bake_scene.hpp"

namespace papilla::app {

/// The machine-readable result of a bake: plan, parts, materials, distortion, losses, warnings.
nlohmann::ordered_json bake_json(const BakeResult& result, const std::vector<Surface>& planned);

/// A table for people: one row a surface with grain.
std::string bake_table(const BakeResult& result);

/// Writes the pictures of a bake into `folder` and returns their names: the scene with its materials, with a checker,
/// the uv layout of every surface with grain, and the relief of every grain.
std::vector<std::string> write_pictures(const BakeResult& result, const std::filesystem::path& folder,
                                        const ProgressCallback& progress);

}  // namespace papilla::app
