// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

#include "papilla/meshing/chart_set.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::param_detail {

/// The uv with offset[chart] added to every value of the chart.
/// @throws InvalidInput naming `function` when two charts share a value.
CornerAttribute<Vec2> move_charts(const CornerAttribute<Vec2>& uv, const ChartSet& charts,
                                  const std::vector<Vec2>& offset, std::string_view function);

/// @throws InvalidInput unless every triangle has a chart below the count and three finite uv.
void check_flattening(const CornerAttribute<Vec2>& uv, const ChartSet& charts, std::string_view function);

}  // namespace papilla::param_detail
