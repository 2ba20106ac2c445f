// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Options of split_nonmanifold().
struct ManifoldOptions {
  double relative_gap = 3e-6;  ///< How far parted sheets are moved from each other, of the bounding diagonal, in
                               ///< [0, 0.01]. Larger than the weld's tolerance and than single precision, so that
                               ///< neither a weld nor a file joins them again.
};

struct ManifoldResult {
  TriangleMesh mesh;
  std::size_t parted_edges = 0;    ///< Edges of more than two triangles, or of two that run the same way.
  std::size_t added_vertices = 0;  ///< Copies of vertices, so that each has one fan of triangles.
  std::size_t split_edges = 0;     ///< Edges that needed a vertex in the middle to be parted.
  double max_deviation_mm = 0;     ///< The furthest that a copy was moved.
};

/// Makes the mesh manifold by parting it where sheets touch. At an edge of more than two triangles those are paired
/// around the edge, each with the next one on its inner side, so that touching solids part into solids; what finds no
/// partner gets a border. Edges whose two triangles run the same way are cut (orient() leaves them only where a surface
/// is non-orientable), and those between front and back of a double sheet. Then every vertex is copied until each copy
/// has one fan of triangles. Copies at parted edges move into their own sheet (behind it where their fan lies all
/// around them, before it where it is one side of a double sheet) by `relative_gap`, or a fifth of the shortest edge
/// around when that is less, and by up to sixteen times that where other vertices are in the way; copies of a vertex
/// where sheets only touch in that point stay where they are. Good input is welded by index, oriented, without
/// degenerate triangles and duplicates that run the same way. O(n), with parted edges O(n log n); deterministic.
/// @throws InvalidInput when an index is out of range, a position is not finite or the option is out of range.
ManifoldResult split_nonmanifold(TriangleMesh mesh, const ManifoldOptions& options = {});

}  // namespace papilla
