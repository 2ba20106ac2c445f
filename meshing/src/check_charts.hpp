// SPDX-License-Identifier: MIT
#pragma once

#include "edge_table.hpp"
#include "papilla/meshing/chart_set.hpp"

namespace papilla::detail {

/// @throws InvalidInput naming `function` when the mesh has a bad index or coordinate, or the charts don't fit it.
void check_charts(const TriangleMesh& mesh, const ChartSet& charts, const char* function);

/// The opposite half-edges within each chart, cuts open.
/// @throws InvalidInput naming `function` for a cut that is no edge within a chart.
std::vector<Index> opposite_within_charts(const TriangleMesh& mesh, const EdgeTable& edges, const ChartSet& charts,
                                          const char* function);

}  // namespace papilla::detail
