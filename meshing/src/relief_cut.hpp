// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "chart_field.hpp"
#include "seam_weights.hpp"

namespace papilla::detail {

/// Cuts that relieve a chart's distortion, as piece half-edges, one per edge. Each starts where the scale of the map of
/// ChartField is farthest from the border's: a slit to the border along the path of least cost, where the surface
/// bulges, or a cut across, along the ridge of the scale. A cut is taken while it lowers the distortion by more than
/// `seam_cost` times its cost (SeamWeights) over the square root of the piece's area.
std::vector<Index> relieve(const Piece& piece, ChartField& field, const SeamWeights& weights, double seam_cost);

}  // namespace papilla::detail
