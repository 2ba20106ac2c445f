// SPDX-License-Identifier: MIT
#pragma once

#include "shorten_seams.hpp"

namespace papilla::param_detail {

/// Lays stretches of seam along cheaper ways between the same two ends, beside the old ones, as far as the bound allows
/// it.
/// @param state keeps the bound. @return a state that keeps it too and whose seams cost no more.
SeamState straighten_seams(const SeamMesh& mesh, SeamState state, const DistortionBound& bound, const MapSeams& map,
                           const Deadline& deadline);

}  // namespace papilla::param_detail
