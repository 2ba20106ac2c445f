// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/meshing/chart_set.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// The charts that the mesh's own uv (channel 0) has: pieces of surface connected over edges of exactly two triangles
/// that run it opposite ways and have equal uv at both of its ends. Seams that have one chart on both
/// sides become its cuts. What the uv are does not matter: they may be flipped, overlap or have no area. Equal
/// positions must be one vertex. O(n log n); deterministic.
/// @throws InvalidInput when a triangle has no uv, a uv is not finite or an index is out of range.
ChartSet uv_charts(const TriangleMesh& mesh);

/// @throws InvalidInput, naming the first triangle, when the mesh has a triangle without uv.
void require_uv(const TriangleMesh& mesh);

}  // namespace papilla
