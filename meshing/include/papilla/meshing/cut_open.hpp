// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "papilla/meshing/chart_set.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// The mesh with its charts' cuts open: a vertex that cuts divide within a chart appears once per fan, so that methods
/// which find neighbours by vertex numbers see the cuts as borders. Triangles and their order, attributes and the
/// vertices' numbers stay; copies of vertices follow behind. uv per corner made for it fits the mesh as it was.
/// Without cuts the mesh comes back unchanged. O(n); deterministic.
/// @throws InvalidInput when the charts don't fit the mesh, a cut is out of range or on a border, or an index is out of
/// range.
TriangleMesh cut_open(TriangleMesh mesh, const ChartSet& charts);

/// Length of the interior edges between different charts and of the cuts, each once [mm].
/// @throws InvalidInput as cut_open().
double seam_length(const TriangleMesh& mesh, const ChartSet& charts);

/// Gives charts the cuts of another set of charts of the same mesh, of which they may be parts: those of the half-edges
/// that lie within one of `charts`. Replaces its cuts and seam length. O(n).
/// @throws InvalidInput when the charts don't fit the mesh or an index is out of range.
void keep_cuts(const TriangleMesh& mesh, std::span<const Index> halfedges, ChartSet& charts);

}  // namespace papilla
