// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "shorten_seams.hpp"

namespace papilla::param_detail {

/// Lets slits run on from their tips, straight on in the map, until the bound is kept: those first whose tips release
/// most energy per length, π δ² / (4 r) where the slit is δ wide at the distance r from its tip, the reverse of what
/// shorten_seams() counts for closing it. Stops before borders and other seams.
/// @param state valid, just beyond the bound. @param map measures all that it maps, whatever it comes to.
/// @return a state that keeps the bound; nothing where a few rounds do not get there.
std::optional<SeamState> lengthen_seams(const SeamMesh& mesh, SeamState state, const DistortionBound& bound,
                                        const MapSeams& map, const Deadline& deadline);

}  // namespace papilla::param_detail
