// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "papilla/io/scene.hpp"

namespace papilla {

/// Where a node stands in the hierarchy.
struct NodePlace {
  std::string name;                     ///< Its own, or "#" and its number among its siblings when it has none.
  std::string path;                     ///< Names from the root down to it, joined by '/'.
  std::optional<std::uint32_t> parent;  ///< Node above it.
};

/// The places of all nodes; of one that no root leads to, all is empty.
/// @throws InvalidInput as instances().
std::vector<NodePlace> node_places(const Scene& scene);

/// What people are shown as a part's name: its own, or the path of its first node when it has none.
const std::string& shown_name(const Part& part);

}  // namespace papilla
