// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "bound_keeper.hpp"

namespace papilla::param_detail {

struct CoarseSeams {
  /// Keeps the bound; when the deadline has passed, perhaps not; nothing: none came of it.
  std::optional<SeamState> state;
  double price = 0;  ///< What it costs over the cheapest that was lifted and near the bound, at least 1.
};

/// Seeks seams on a coarse mesh of a surface and finishes them on the fine one. What bound the coarse seams have to
/// keep so that the fine ones keep theirs is found as it goes: of the same seams, the finer mesh has another
/// distortion.
/// @param fine of the surface, for the bound.
CoarseSeams seams_from_coarse(BoundKeeper& fine, const DistortionBound& bound, const CoarseSurface& coarse,
                              const Deadline& deadline, SeamTrace& trace);

}  // namespace papilla::param_detail
