// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "seam_state.hpp"

namespace papilla::param_detail {

/// Brings maps of a coarse mesh to the fine one whose vertices it has some of.
class MapLifter {
 public:
  /// Finds for each fine triangle the coarse one, of those around the nearest coarse vertices, in which its middle
  /// lies, or nearly so. O(n log n). @param vertices of the fine mesh, one per vertex of the coarse one.
  MapLifter(const SeamMesh& fine, const SeamMesh& coarse, std::span<const Index> vertices);

  /// Where the fine triangles come to lie by a map: each by the affine map of its coarse one. Triangles do not hang
  /// together; what lies across a seam of the coarse map may have come to its other side. O(n).
  /// @param uv of all triangles of the coarse mesh.
  CornerAttribute<Vec2> lift(const CornerAttribute<Vec2>& uv) const;

 private:
  const TriangleMesh &fine_, &coarse_;
  std::vector<Index> under_;  ///< Per fine triangle: the coarse one.
};

}  // namespace papilla::param_detail
