// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/pipeline/bake_scene.hpp"

namespace papilla {

/// Writes pictures of a bake into `folder`: the scene with its materials and with a checker, close-ups of every grain,
/// the uv layout of the largest surfaces, and the relief of every grain.
/// @return their names. @throws IoError when one can't be written.
std::vector<std::string> write_bake_pictures(const BakeResult& result, const std::filesystem::path& folder,
                                             const ProgressCallback& progress = {});

}  // namespace papilla
