// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "chart_pieces.hpp"
#include "corners_of_vertices.hpp"

namespace papilla::param_detail {

/// Mends a map of which little is wrong: where triangles are turned over, and where the border meets itself, vertices
/// are drawn to the middle of their neighbours a few times; those of the border to where their triangles' shapes put
/// them, so that these turn back.
/// @return whether every triangle is positive and no edges of the border meet.
bool mend_map(const ChartSurface& chart, const CornersOfVertices& corners, std::vector<Vec2>& uv);

}  // namespace papilla::param_detail
