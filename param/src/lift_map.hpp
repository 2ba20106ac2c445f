// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "seam_state.hpp"

namespace papilla::param_detail {

/// Where the triangles of a fine mesh come to lie by the map of a coarse one whose vertices are some of its own: each
/// by the affine map of a coarse triangle around the nearest coarse vertices, that which its middle lies in, or nearly
/// so. Triangles do not hang together; what lies across a seam of the coarse map may have come to its other side.
/// O(n log n).
/// @param vertices of the fine mesh, one per vertex of the coarse one. @param uv of all triangles of the coarse mesh.
CornerAttribute<Vec2> lift_map(const SeamMesh& fine, const SeamMesh& coarse, std::span<const Index> vertices,
                               const CornerAttribute<Vec2>& uv);

}  // namespace papilla::param_detail
