// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "papilla/meshing/chart_set.hpp"
#include "segmented_mesh.hpp"

namespace papilla::detail {

/// Per half-edge: is it a border of the surface, of its label, or a cut? The same on both sides.
std::vector<std::uint8_t> seams_of(const SegmentedMesh& surface, const std::vector<std::uint32_t>& labels,
                                   const std::vector<std::uint32_t>& cuts);

/// The charts that seams leave.
ChartSet charts_between(const SegmentedMesh& surface, const std::vector<std::uint8_t>& seam);

}  // namespace papilla::detail
