// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/io/scene.hpp"

namespace papilla {

/// Name of the root that write_glb() adds to turn Z up to Y up; paths leave it out, so that they stay over re-import.
inline constexpr std::string_view k_turn_node_name = "Z up to Y up";

/// Where a node stands in the hierarchy.
struct NodePlace {
  std::string name;                     ///< Its own, or "#" and its number among its siblings when it has none.
  std::string path;                     ///< Names from the root down to it, joined by '/'.
  std::optional<std::uint32_t> parent;  ///< Node above it.
};

/// The places of all nodes; of one that no root leads to, all is empty. Cost: O(nodes x depth), for the paths.
/// @throws InvalidInput as instances().
std::vector<NodePlace> node_places(const Scene& scene);

/// What people are shown as a part's name: its own, or the path of its first node when it has none.
const std::string& shown_name(const Part& part);

}  // namespace papilla
