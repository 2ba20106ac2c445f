// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "chart_pieces.hpp"
#include "corners_of_vertices.hpp"

namespace papilla::param_detail {

/// Mends a map of which little is wrong. Where triangles are turned over, one vertex after the other goes to the middle
/// of its neighbours, on the border to where its triangles' shapes put it, or, where these are not positive then, to
/// the middle of the places where they are. Then, where the border meets itself, vertices are drawn towards the middle
/// of their neighbours, and with them those of the short stretch of border between edges that cross. After some rounds,
/// neighbours go with them.
/// @return whether every triangle is positive and no edges of the border meet.
bool mend_map(const ChartSurface& chart, const CornersOfVertices& corners, std::vector<Vec2>& uv);

}  // namespace papilla::param_detail
