// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "chart_pieces.hpp"

namespace papilla::param_detail {

/// A map of a chart from one of the same triangles that was cut in another way (ChartSurface::nearby). Pieces that are
/// joined are laid against each other as they are; where seams are closed, the triangles around are put together anew
/// by place_rigidly(), and all of them where they came in many pieces, as from lift_map(); what is turned over then, or
/// meets as a seam was opened, goes through mend_map().
/// @return per vertex; every triangle is positive, no edges of the border meet. Nothing where that does not come of it.
std::optional<std::vector<Vec2>> stitched_start(const ChartSurface& chart);

}  // namespace papilla::param_detail
