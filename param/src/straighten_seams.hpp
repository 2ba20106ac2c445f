// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "shorten_seams.hpp"

namespace papilla::param_detail {

/// Lays stretches of seam along cheaper ways between the same two ends, beside the old ones, as far as the bound allows
/// it.
/// @param state keeps the bound. @return a state that keeps it too and whose seams cost no more.
SeamState straighten_seams(const SeamMesh& mesh, SeamState state, const DistortionBound& bound, const MapSeams& map,
                           const Deadline& deadline);

/// The same without a bound and a map, for seams that need none yet: zigzags are straightened, ways stay within a
/// distance of the old ones and go around the same places.
/// @param seam per half-edge, as SeamState::seam.
std::vector<std::uint8_t> straightened(const SeamMesh& mesh, std::vector<std::uint8_t> seam, double most_mm);

}  // namespace papilla::param_detail
