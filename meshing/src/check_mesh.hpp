// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>

#include "edge_table.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/meshing/chart_set.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::detail {

/// Throws InvalidInput naming `function`, the array and the index unless every index of the mesh is in range,
/// every referenced position is finite, per-triangle arrays are empty or complete, and half-edges fit into Index.
void check_mesh(const TriangleMesh& mesh, std::string_view function);

/// @throws InvalidInput naming `function` when the mesh has a bad index or coordinate, or the charts don't fit it.
void check_charts(const TriangleMesh& mesh, const ChartSet& charts, const char* function);

/// @throws InvalidInput naming `function` when the charts don't fit the number of triangles.
void check_chart_numbers(const TriangleMesh& mesh, const ChartSet& charts, const char* function);

/// The opposite half-edges within each chart, cuts open.
/// @throws InvalidInput naming `function` for a cut that is no edge within a chart.
std::vector<Index> opposite_within_charts(const TriangleMesh& mesh, const EdgeTable& edges, const ChartSet& charts,
                                          const char* function);

/// Parts opposite half-edges within charts along cuts.
/// @throws InvalidInput naming `function` for a cut that is no edge within a chart.
void open_cuts(std::span<const Index> cuts, std::span<Index> opposite, const char* function);

/// Whether a position is finite and within 1e15 mm, beyond which single precision boxes of size ratios overflow.
bool is_distance_position(const Vec3& p) noexcept;
inline constexpr const char* k_no_distance_position = "not finite or beyond 1e15 mm";

/// Adds the positions that triangles name to `bounds`. Throws InvalidInput naming `what` and the index when a
/// triangle names a position that does not exist, or one that is no distance position.
void check_distance_input(const TriangleMesh& mesh, std::string_view what, Bounds3& bounds);

}  // namespace papilla::detail
