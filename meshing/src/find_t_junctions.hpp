// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "edge_table.hpp"

namespace papilla::detail {

/// A boundary vertex that lies inside another boundary edge.
struct TJunction {
  Index halfedge = 0;  ///< The boundary edge, running as in its triangle.
  Index vertex = 0;
  double s = 0;  ///< Where on the half-edge, in (0, 1).
};

/// All T-junctions: boundary vertices (of edges with one half-edge) nearer than `reach` to another boundary edge and
/// further than `from_ends` from its ends. Sorted by (half-edge, s, vertex). Each vertex must have its own position.
/// O(n log n) for n boundary edges whose neighbourhoods are bounded; deterministic, parallel.
std::vector<TJunction> find_t_junctions(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                        const EdgeTable& edges, double reach, double from_ends);

}  // namespace papilla::detail
