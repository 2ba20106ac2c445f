// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "shorten_seams.hpp"

namespace papilla::param_detail {

/// Lets slits run on and new ones begin until the bound is kept: along those ways of slit_fronts() first that release
/// most energy per cost. Each round maps what was lengthened and compares what came of every way with what was
/// foreseen: a place that released less counts for less from then on, and a round that released nothing is taken back.
/// @param state valid, beyond the bound. @param map measures all that it maps, whatever it comes to.
/// @return a state that keeps the bound; nothing where six maps do not get there.
std::optional<SeamState> lengthen_seams(const SeamMesh& mesh, SeamState state, const DistortionBound& bound,
                                        const MapSeams& map, const Deadline& deadline);

}  // namespace papilla::param_detail
