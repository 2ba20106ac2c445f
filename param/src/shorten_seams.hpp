// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "seam_state.hpp"

namespace papilla::param_detail {

/// Maps charts and measures the map.
using MapCharts = std::function<SeamState(const ChartSet&)>;

/// Closes slits from their tips and joins charts as far as the bound allows it, in rounds, as keep_bound() says.
/// @param state keeps the bound. @return a state that keeps it too and whose seams cost no more.
SeamState shorten_seams(const SeamMesh& mesh, SeamState state, const DistortionBound& bound, const MapCharts& map,
                        const Deadline& deadline);

}  // namespace papilla::param_detail
