// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "seam_state.hpp"

namespace papilla::param_detail {

/// A stretch of seam between two places where seams meet, end, or reach the border of the mesh.
struct SeamPath {
  std::vector<Index> halfedges;                   ///< In order, of the triangles on the left; at least one.
  bool tip_at_start = false, tip_at_end = false;  ///< The seam ends there within a chart.
};

/// All stretches of seam: every seam edge that is no border of the mesh lies on exactly one. Deterministic. O(n).
/// @param seam per half-edge, as SeamState::seam.
std::vector<SeamPath> seam_paths(const SeamMesh& mesh, const std::vector<std::uint8_t>& seam);

}  // namespace papilla::param_detail
