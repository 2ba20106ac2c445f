// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "papilla/core/vec.hpp"

namespace papilla::detail {

struct UvTriangle {
  std::array<Vec2, 3> corners;  ///< Counter-clockwise.
  std::uint32_t chart = 0;
};

struct UvOverlap {
  std::vector<char> overlaps;  ///< Per triangle.
  double fraction = 0;         ///< Area covered more than once / area covered.
};

/// Overlap among all triangles, or (`within_charts`) only among triangles of the same chart.
/// @param triangles with positive area.
UvOverlap find_uv_overlap(const std::vector<UvTriangle>& triangles, bool within_charts, int rows);

}  // namespace papilla::detail
