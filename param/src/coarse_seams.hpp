// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "bound_keeper.hpp"

namespace papilla::param_detail {

/// Seeks seams on a coarse mesh of a surface and finishes them on the fine one. What bound the coarse seams have to
/// keep so that the fine ones keep theirs is found as it goes: of the same seams, the finer mesh has another
/// distortion.
/// @param fine of the surface, for the bound. @return a state that keeps the bound; when the deadline has passed, one
/// that does not; nothing where none comes of it.
std::optional<SeamState> seams_from_coarse(BoundKeeper& fine, const DistortionBound& bound, const CoarseSurface& coarse,
                                           const Deadline& deadline, SeamTrace& trace);

}  // namespace papilla::param_detail
