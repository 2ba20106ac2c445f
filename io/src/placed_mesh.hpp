// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "papilla/io/scene.hpp"

namespace papilla {

/// An instance with its transform applied: what formats without a node tree write.
struct PlacedMesh {
  std::string name;            ///< The node's, or else the part's.
  const Part* part = nullptr;  ///< Triangles and attributes other than positions and normals.
  Values<Vec3> positions, normals;
  bool mirrored = false;  ///< The transform turns the surface inside out: write triangles backwards.
};

/// @throws InvalidInput as instances(), when an index is out of range or a position is not finite.
PlacedMesh place(const Scene& scene, const Instance& instance);

/// The corners of a triangle in the order in which they are to be written.
inline std::array<std::size_t, 3> corner_order(const PlacedMesh& mesh) {
  return mesh.mirrored ? std::array<std::size_t, 3>{0, 2, 1} : std::array<std::size_t, 3>{0, 1, 2};
}

}  // namespace papilla
