// SPDX-License-Identifier: MIT
#pragma once

#include "shorten_seams.hpp"

namespace papilla::param_detail {

/// Exchanges stretches of seam, without which the seams of a chart would fall into two pieces, for the cheapest way
/// between these pieces (the key-path exchange of Steiner trees, [Voß 1992]). Of a stretch only so much goes as the way
/// costs: the rest becomes a slit.
/// @param state keeps the bound. @param map_fully measures all that it maps, whatever it comes to.
/// @return a state that keeps it too and whose seams cost no more.
SeamState reconnect_seams(const SeamMesh& mesh, SeamState state, const DistortionBound& bound, const MapSeams& map,
                          const MapSeams& map_fully, const Deadline& deadline);

}  // namespace papilla::param_detail
