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

/// Only the topology: cuts a patch until every piece is of genus 0 with a border, or a disk.
void open_patch(const Surface& surface, const SeamWeights& weights, bool disks, std::vector<Index> triangles,
                PieceCutter& cutter, std::vector<std::uint8_t>& seam);

}  // namespace papilla::detail
