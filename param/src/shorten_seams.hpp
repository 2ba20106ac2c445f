// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "seam_state.hpp"

namespace papilla::param_detail {

/// Maps the charts that seams leave, per half-edge as SeamState::seam, and measures the map. Where that is not valid or
/// breaks the bound, it may have neither uv nor seams, and what is wrong with it may be known only in part.
/// @param nearby a state whose seams are much the same, with its uv: the map begins there.
using MapSeams = std::function<SeamState(const std::vector<std::uint8_t>& seam, const SeamState& nearby)>;

/// Closes slits from their tips and joins charts as far as the bound allows it, in rounds, as keep_bound() says.
/// @param state keeps the bound. @param doubt per half-edge: what closing a seam there costs over what is foreseen, as
/// was learnt so far; 1 where nothing is known. Is learnt from what is tried here. @param most_failures after so many
/// maps that break the bound it ends. @return a state that keeps it too and whose seams cost no more.
SeamState shorten_seams(const SeamMesh& mesh, SeamState state, const DistortionBound& bound, const MapSeams& map,
                        std::vector<double>& doubt, const Deadline& deadline, int most_failures = 6);

}  // namespace papilla::param_detail
