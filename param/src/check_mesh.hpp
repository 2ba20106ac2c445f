// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "papilla/meshing/chart_set.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::param_detail {

/// @throws InvalidInput naming `function` and the first vertex or triangle when a position is not finite or too large
///         to be squared, an index is out of range, or the mesh has 2^30 triangles or more.
void check_mesh(const TriangleMesh& mesh, std::string_view function);

/// @throws InvalidInput unless every triangle has a chart number below the count.
void check_charts(const TriangleMesh& mesh, const ChartSet& charts, std::string_view function);

/// @throws InvalidInput unless every triangle has three uv that exist and are finite.
void check_uv(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv, std::string_view function);

}  // namespace papilla::param_detail
