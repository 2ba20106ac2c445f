// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "piece.hpp"
#include "seam_weights.hpp"

namespace papilla::detail {

/// Half-edges of a piece that make it genus 0 with a border when cut, along short paths of little weight: handles are
/// opened, border loops joined [Erickson, Whittlesey 2005], a sphere slit between two far points. Without `all_loops`,
/// holes stay that a flat sheet could have (their turning is -2π within k_hole_turning_deg), since they need no cut to
/// be flattened. Nothing when OpenMesh can't hold the piece.
struct Opening {
  bool possible = true;
  std::vector<Index> cuts;  ///< Piece half-edges, one per edge; empty: nothing to do.
};
Opening open_chart(const Piece& piece, const SeamWeights& weights, bool all_loops);

}  // namespace papilla::detail
