// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "chart_outline.hpp"
#include "piece.hpp"
#include "seam_weights.hpp"

namespace papilla::detail {

struct UnfoldOptions {
  double seam_cost = 0;
  std::function<Vec3(Vec3)> grain;
};

/// Joins charts over a common stretch of border where the union unfolds into the plane: angles add up to 2π along the
/// stretch, or the distortion that comes in is worth the seam that goes (as in relieve()); the union's outline does
/// not overlap itself; the stretch is a fair part of the smaller chart's border; and with a grain direction both
/// charts' grains run the same way. The costliest stretches go first. Other common stretches of the two charts stay as
/// seams, so that genus 0 stays genus 0. Small charts join by the longest stretch whatever it costs. Clears `seam`
/// where charts were joined.
std::vector<ChartOutline> merge_unfolded(const Surface& surface, const SeamWeights& weights,
                                         const UnfoldOptions& options, std::vector<std::uint8_t>& seam,
                                         std::vector<ChartOutline> charts);

}  // namespace papilla::detail
