// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "papilla/io/scene.hpp"

namespace papilla {

/// A part that was replaced by another one that equals it.
struct SharedPart {
  std::string name, id;        ///< Its shown_name() and its own id, as they were.
  std::uint32_t number = 0;    ///< In the scene's old numbers.
  std::uint32_t original = 0;  ///< In the scene's new numbers.
  double max_distance_mm = 0;  ///< Largest distance between corresponding vertices.
};

/// Tells parts apart that must stay apart although their meshes are equal, for example by what is assigned to them.
using PartLabel = std::function<std::uint64_t(std::uint32_t part)>;

/// Makes every class of identical parts (find_identical_parts(): same mesh after a rigid motion, same attributes, same
/// materials and extras) one part: the nodes of the copies show the first of the class, moved into place. What is
/// computed per part is then computed once, and write_glb() stores it once. A copy's name stays as the name of a node.
/// Nodes get no new parent; where one has children, shears or has another name, the motion goes into a new child.
/// @param label May be empty. Cost and determinism: as find_identical_parts().
/// @throws InvalidInput as find_identical_parts(), naming the part.
std::vector<SharedPart> share_identical_parts(Scene& scene, const PartLabel& label = {});

}  // namespace papilla
