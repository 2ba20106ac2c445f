// SPDX-License-Identifier: MIT
#pragma once

#include "shorten_seams.hpp"

namespace papilla::param_detail {

/// Brings the distortion below the bound and back to it, as long as the seams become shorter by that: slits run on
/// where this releases most energy per length and are closed where it takes least. At a minimum of seams all tips
/// release the same.
/// @param state keeps the bound. @param map_fully measures all that it maps, whatever it comes to.
/// @return a state that keeps it too and whose seams cost no more.
SeamState exchange_seams(const SeamMesh& mesh, SeamState state, const DistortionBound& bound, const MapSeams& map,
                         const MapSeams& map_fully, const Deadline& deadline);

}  // namespace papilla::param_detail
