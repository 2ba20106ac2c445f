// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

struct OrientResult {
  TriangleMesh mesh;
  std::size_t reversed = 0;           ///< Triangles that were turned over.
  std::size_t components = 0;         ///< Sets of triangles connected through edges of exactly two triangles.
  std::size_t closed = 0;             ///< Components without border.
  std::size_t conflicting_edges = 0;  ///< Edges left with both triangles running the same way: where a non-orientable
                                      ///< component must be cut.
};

/// Turns triangles over until neighbours agree: across every edge of exactly two triangles these run opposite ways,
/// unless the component is non-orientable. Closed components are then turned outward: signed volume > 0, or < 0 for the
/// wall of a cavity (an inward, consistent component inside an odd number of other closed components). Open ones take
/// the sense that most of their triangles had. Turned triangles have corners 1 and 2 swapped and normals negated.
/// Good input is welded by index. O(n), plus O(n) for each inward closed component inside another's box. Deterministic.
/// @throws InvalidInput when an index is out of range or a position is not finite.
OrientResult orient(TriangleMesh mesh);

/// Turns the triangles whose flag is set over: corners 1 and 2 swapped, normals negated; uv stay with their corners, so
/// that charts of turned triangles are mirrored.
/// @param turn A flag a triangle. @throws InvalidInput when there are more or fewer.
void turn_triangles(TriangleMesh& mesh, const std::vector<std::uint8_t>& turn);

}  // namespace papilla
