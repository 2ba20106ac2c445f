// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/meshing/chart_set.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Every connected piece of the mesh as one chart, numbered by its first triangle. Triangles are connected over edges
/// of exactly two triangles that run it in opposite directions. O(n).
/// @throws InvalidInput when a position is not finite or an index is out of range.
ChartSet components_as_charts(const TriangleMesh& mesh);

/// Refuses meshes with an edge of three or more triangles, or one that two triangles run in the same direction: their
/// components are no surfaces that could be kept as they are. O(n log n).
/// @throws InvalidInput naming the edge's vertices and a triangle; as components_as_charts().
void require_manifold(const TriangleMesh& mesh);

}  // namespace papilla
