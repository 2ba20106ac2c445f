// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::param_detail {

inline constexpr Index k_no_triangle = ~Index{0};

/// The next and the last corner (3 t + k) of the same triangle.
constexpr Index next(Index corner) noexcept { return corner % 3 == 2 ? corner - 2 : corner + 1; }
constexpr Index previous(Index corner) noexcept { return corner % 3 == 0 ? corner + 2 : corner - 1; }

/// Which triangle lies across each edge. Entry 3 t + k belongs to the edge from corner k of triangle t to the next one.
using Adjacency = std::vector<Index>;

/// Links two triangles over an edge that exactly these two have, once in each direction. Every other edge (border,
/// three or more triangles, inconsistent orientation, repeated corner) has k_no_triangle.
/// Cost: O(n) for bounded valence, O(n log n) for any.
Adjacency connect_triangles(const TriangleMesh& mesh);

}  // namespace papilla::param_detail
