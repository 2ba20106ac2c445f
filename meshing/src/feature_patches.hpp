// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "papilla/meshing/segmentation.hpp"
#include "surface.hpp"

namespace papilla::detail {

/// Per half-edge: is it a border, or bent by more than the feature angle?
std::vector<std::uint8_t> feature_halfedges(const Surface& surface, double feature_angle_deg);

/// Labels of the pieces that half-edges which are no feature connect; `count` tells how many.
std::vector<std::uint32_t> feature_patches(const Surface& surface, const std::vector<std::uint8_t>& feature,
                                           std::uint32_t& count);

/// Per triangle: this fraction of its component's area.
std::vector<double> speck_areas(const Surface& surface, double fraction);

/// Lets patches below `small_area_fraction` of a neighbour's area, or below `speck_area_fraction` of their component's,
/// join the neighbour with the longest common border. Labels must be dense; returns the new count.
std::uint32_t absorb_small(const Surface& surface, const SegmentationOptions& options,
                           std::vector<std::uint32_t>& labels);

}  // namespace papilla::detail
