// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace papilla {

/// Writes the inputs that an evaluation has of its own into a folder: disks of growing curvature for the kinds that
/// take meshes, fractal surfaces for `fractal`, lattices under noise for `symmetry`, reliefs for `height`, solids of
/// known area for `tessellation`, a baked dome with leather on it for `contact`.
/// @returns the files.
/// @throws IoError when they can't be written.
std::vector<std::string> write_built_in_inputs(const std::string& kind, const std::filesystem::path& folder);

}  // namespace papilla
