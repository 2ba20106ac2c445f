// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// The attribute as one value per position, for formats that know no other; nothing when the mesh lacks it, a triangle
/// lacks it, or it jumps at a position. Positions without triangles get T{}.
/// @pre indices in range.
template <class T>
std::optional<std::vector<T>> value_per_position(const TriangleMesh& mesh, const CornerAttribute<T>& attribute) {
  if (attribute.empty()) return std::nullopt;
  std::vector<T> values(mesh.positions.size());
  std::vector<bool> known(mesh.positions.size(), false);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!attribute.has_value(t)) return std::nullopt;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index vertex = mesh.triangles[t][k];
      const T& value = attribute.values[attribute.indices[t][k]];
      if (known[vertex] && !(values[vertex] == value)) return std::nullopt;
      known[vertex] = true;
      values[vertex] = value;
    }
  }
  return values;
}

}  // namespace papilla
