// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "papilla/io/gltf_reader.hpp"

namespace papilla {

/// A node with coarser levels of detail (MSFT_lod); numbers of the scene's nodes.
struct GltfLevels {
  std::uint32_t node = 0;             ///< The finest level.
  std::vector<std::uint32_t> levels;  ///< Ever coarser; no other node need have them as children.
};

/// read_gltf() for those who show: coarser levels of detail stay, with the nodes that show them and the screen
/// coverages in extras.
/// @throws as read_gltf().
Scene read_gltf_levels(const std::filesystem::path& path, const GltfReadOptions& options,
                       std::vector<GltfLevels>& levels);

}  // namespace papilla
