// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace papilla {

/// A partition of a mesh's triangles into charts, each a connected piece of surface, and the cuts within charts.
struct ChartSet {
  std::vector<std::uint32_t> of_triangle;  ///< Chart number per triangle, in [0, count).
  std::uint32_t count = 0;
  /// Length of the seams, each edge counted once: interior edges between different charts, and cuts.
  double seam_length_mm = 0;
  /// Seams that have one chart on both sides, such as the one that opens a tube: half-edges 3 t + k, from corner k of
  /// triangle t to the next, one per edge, ascending. cut_open() makes them borders. Among them are
  /// edges of three or more triangles of which one chart has two; they count for no length.
  std::vector<std::uint32_t> cuts = {};
};

}  // namespace papilla
