// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include "check_distance_input.hpp"
#include "papilla/meshing/placed_mesh.hpp"

namespace papilla::detail {

/// The parts' triangles in the scene's space, one part after the other.
struct WorldScene {
  std::vector<TriangleMesh> parts;
  Bounds bounds;
};

/// @throws InvalidInput naming function and part when a mesh is missing or has a bad index or coordinate, or is not
///         finite where it stands.
WorldScene place(std::span<const PlacedMesh> parts, const std::string& function);

/// The triangles of the parts that are opaque as one list.
/// @param first  becomes a number a part: where its triangles begin, or k_no_value when it is not opaque.
TriangleMesh opaque_triangles(const WorldScene& scene, std::span<const PlacedMesh> parts, std::vector<Index>& first);

}  // namespace papilla::detail
