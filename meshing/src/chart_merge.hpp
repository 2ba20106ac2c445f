// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "papilla/meshing/segmentation.hpp"
#include "surface.hpp"

namespace papilla::detail {

/// Merges neighbouring charts, longest common border first, whose union keeps to the cone of normals and whose common
/// border is mostly no feature. Labels must be dense; returns the new count.
std::uint32_t merge_fitting(const Surface& surface, const std::vector<std::uint8_t>& feature,
                            const SegmentationOptions& options, std::vector<std::uint32_t>& labels);

/// Lets charts below `small_area_fraction` of a neighbour's area, or below `speck_area_fraction` of their component's,
/// join the neighbour with the longest common border.
/// Labels must be dense; returns the new count.
std::uint32_t absorb_small(const Surface& surface, const std::vector<std::uint8_t>& feature,
                           const SegmentationOptions& options, std::vector<std::uint32_t>& labels);

}  // namespace papilla::detail
