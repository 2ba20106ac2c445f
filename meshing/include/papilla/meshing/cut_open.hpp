// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "papilla/meshing/chart_set.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Opens cuts of one mesh again and again: its edges are found once. O(n) each time, deterministic.
class CutOpener {
 public:
  /// @param mesh has to stay as it is while cuts of it are opened.
  /// @throws InvalidInput for an index out of range or a coordinate that is not finite.
  explicit CutOpener(const TriangleMesh& mesh);
  explicit CutOpener(TriangleMesh&&) = delete;

  /// As cut_open().
  TriangleMesh open(const ChartSet& charts) const;

  /// As seam_length().
  double seam_length(const ChartSet& charts) const;

  /// Gives charts the cuts of another set of charts, of which they may be parts: those of the half-edges that lie
  /// within one of `charts`. Replaces their cuts and seam length.
  /// @throws InvalidInput when the charts don't fit the mesh or a half-edge is out of range.
  void keep_cuts(std::span<const Index> halfedges, ChartSet& charts) const;

 private:
  std::vector<Index> opposite_within(const ChartSet& charts) const;
  std::vector<Index> opposite_where_closed(const ChartSet& charts, const char* function) const;
  double length_of_seams(const std::vector<Index>& closed) const;

  const TriangleMesh& mesh_;
  std::vector<Index> opposite_;              ///< Per half-edge of an edge of two that run opposite ways.
  std::vector<std::vector<Index>> crowded_;  ///< The half-edges of other edges that have several.
};

/// The mesh with its charts' cuts open: a vertex that cuts divide within a chart appears once per fan, so that methods
/// which find neighbours by vertex numbers see the cuts as borders. Triangles and their order, attributes and the
/// vertices' numbers stay; copies of vertices follow behind. uv per corner made for it fits the mesh as it was.
/// Without cuts the mesh comes back unchanged. O(n); deterministic.
/// @throws InvalidInput when the charts don't fit the mesh, a cut is out of range or on a border, or an index is out of
/// range.
TriangleMesh cut_open(const TriangleMesh& mesh, const ChartSet& charts);

/// Length of the interior edges between different charts and of the cuts, each once [mm].
/// @throws InvalidInput as cut_open().
double seam_length(const TriangleMesh& mesh, const ChartSet& charts);

}  // namespace papilla
