// SPDX-License-Identifier: MIT
#pragma once

#include "shorten_seams.hpp"

namespace papilla::param_detail {

/// Lets slits end at other vertices: their last edges are exchanged for a cheaper one.
/// @param state keeps the bound. @param map_fully measures all that it maps, whatever it comes to.
/// @return a state that keeps it too and whose seams cost no more.
SeamState move_tips(const SeamMesh& mesh, SeamState state, const DistortionBound& bound, const MapSeams& map,
                    const MapSeams& map_fully, const Deadline& deadline);

}  // namespace papilla::param_detail
