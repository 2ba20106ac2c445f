// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "surface.hpp"

namespace papilla::detail {

/// Lets charts of a single triangle, below `small_area_fraction` of a neighbour's area or below `speck_area_fraction`
/// of their component's join a larger neighbour over the longest unbroken stretch of their common border, whatever it
/// costs; other stretches stay seams, so that no handle and no closed chart comes up. Clears `seam`. Returns how many
/// joined.
std::size_t absorb_charts(const Surface& surface, double small_area_fraction, double speck_area_fraction,
                          std::vector<std::uint8_t>& seam);

}  // namespace papilla::detail
