// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "seam_state.hpp"

namespace papilla::param_detail {

/// Seams of a coarse mesh on the fine one whose vertices it has some of: for each edge the cheapest way near it between
/// its ends, which keeps clear of the others where it can. Then stretches between places where seams meet or end are
/// laid along the cheapest way at most a mean coarse edge of seam beside that. O(n + k log k).
/// @param seam per half-edge of the coarse mesh, as SeamState::seam. @param vertices of the fine mesh, one per vertex
/// of the coarse one. @return the same per half-edge of the fine mesh.
std::vector<std::uint8_t> lift_seams(const SeamMesh& fine, const SeamMesh& coarse, std::span<const Index> vertices,
                                     const std::vector<std::uint8_t>& seam);

}  // namespace papilla::param_detail
