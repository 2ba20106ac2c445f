// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace papilla {

/// The relative paths, percent encoding undone, that a .gltf file names anywhere as "uri": buffers, pictures, height
/// maps of tags, what extensions have. Empty when the file is missing, a GLB or damaged.
std::set<std::string> named_files(const std::filesystem::path& gltf);

/// The size of a file and, when it is a .gltf, of those that it names.
/// @throws std::filesystem::filesystem_error when the file is missing.
std::uintmax_t size_with_named_files(const std::filesystem::path& file);

}  // namespace papilla
