// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "papilla/core/vec.hpp"

namespace papilla::param_detail {

struct UvTriangle {
  std::array<Vec2, 3> corners;  ///< Counter-clockwise.
  std::uint32_t group = 0;      ///< Only triangles of one group can overlap.
};

struct UvOverlap {
  std::vector<char> overlaps;  ///< Per triangle.
  double fraction = 0;         ///< Area covered more than once / area covered.
};

/// @param triangles with positive area.
UvOverlap find_uv_overlap(const std::vector<UvTriangle>& triangles, int rows);

}  // namespace papilla::param_detail
