// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace papilla {

/// A partition of a mesh's triangles into charts, each a connected piece of surface.
struct ChartSet {
  std::vector<std::uint32_t> of_triangle;  ///< Chart number per triangle, in [0, count).
  std::uint32_t count = 0;
  double seam_length_mm = 0;  ///< Length of interior edges between different charts, each counted once.
};

}  // namespace papilla
