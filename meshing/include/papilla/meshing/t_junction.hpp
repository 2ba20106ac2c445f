// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Options of split_t_junctions().
struct TJunctionOptions {
  double relative_tolerance = 1e-6;  ///< How far from an edge a vertex may lie, of the bounding diagonal, in [0, 0.1].
};

struct TJunctionResult {
  TriangleMesh mesh;
  std::size_t split_edges = 0;        ///< Boundary edges that got vertices.
  std::size_t inserted_vertices = 0;  ///< Vertices put into them; one may count for several edges.
  std::size_t slivers = 0;            ///< Border triangles dropped because their own apex lay on their boundary edge.
  std::size_t repeated = 0;           ///< Triangles dropped because they named a vertex twice.
  double max_deviation_mm = 0;        ///< The largest distance of an inserted vertex from its edge.
};

/// Splits every triangle with a boundary edge on which other boundary vertices lie, so that both sides share their
/// vertices and the crack can close. Vertices don't move; attributes are interpolated along the edge.
/// Good input is welded by index. O(n) plus O(b log b) for b boundary edges. Deterministic.
/// @throws InvalidInput when an index is out of range, a position is not finite or the option is out of range.
TJunctionResult split_t_junctions(TriangleMesh mesh, const TJunctionOptions& options = {});

}  // namespace papilla
