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

/// Which triangles of a group run into one another, and how much they cover more than once. The area is summed over
/// `rows` lines through what overlaps, fewer where that took too much memory. Triangles that run into one another by at
/// most 1e-9 of the longer edge touch. Parallel; the result does not depend on the number of threads.
/// @param triangles with positive area.
UvOverlap find_uv_overlap(const std::vector<UvTriangle>& triangles, int rows);

}  // namespace papilla::param_detail
