// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "chart_pieces.hpp"
#include "corners_of_vertices.hpp"

namespace papilla::param_detail {

/// A vector turned as a complex number of length 1 does it.
inline Vec2 turned(Vec2 v, Vec2 by) { return {by.x * v.x - by.y * v.y, by.y * v.x + by.x * v.y}; }

/// Places some vertices of a map anew, the others stay: the least Σ A |J - R J'|² over their triangles, J' what these
/// are in `shapes` and R how they turn, found in turns [Sorkine, Alexa, As-rigid-as-possible surface modeling, 2007].
/// Triangles may come out turned over. O(n^1.5) of the vertices that are placed.
/// @param shapes per triangle of the chart, the uv of its corners. @param free vertices, each once.
/// @param uv per vertex: where they begin and come to.
void place_rigidly(const ChartSurface& chart, const CornersOfVertices& corners,
                   std::span<const std::array<Vec2, 3>> shapes, std::span<const Index> free, std::vector<Vec2>& uv);

}  // namespace papilla::param_detail
