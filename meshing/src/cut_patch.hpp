// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "chart_outline.hpp"
#include "papilla/meshing/segmentation.hpp"
#include "seam_weights.hpp"

namespace papilla::detail {

struct PatchCuts {
  std::size_t opening = 0, relief = 0, halving = 0;  ///< How often each kind of cut was made.
};

/// Cuts a patch until every piece has the topology asked for, is not worth another relief cut, and has an outline that
/// does not overlap itself. Marks `seam`. May run in parallel for different patches.
/// @param triangles connected, with seams or borders around.
std::vector<ChartOutline> cut_patch(const Surface& surface, const SeamWeights& weights,
                                    const SegmentationOptions& options, std::vector<Index> triangles,
                                    PieceCutter& cutter, std::vector<std::uint8_t>& seam, PatchCuts& cuts);

}  // namespace papilla::detail
