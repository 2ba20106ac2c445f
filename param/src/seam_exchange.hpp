// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "shorten_seams.hpp"

namespace papilla::param_detail {

/// Edges of seam and what may stand in their place.
struct SeamExchange {
  std::vector<Index> before, after;  ///< Half-edges.
  double saved = 0;                  ///< Of their cost.
};

/// Tries exchanges, those that save most first, as long as seams become cheaper by them. Where one breaks the bound,
/// slits run on until it is kept; in either case seams are shortened then. Ends after a few that failed.
/// @param find of a state: exchanges in any order. @param least_saving part of what all seams cost that an exchange has
/// to save to be worth a map. @param state keeps the bound. @param map_fully measures all that it
/// maps, whatever it comes to. @return a state that keeps it too and whose seams cost no more.
SeamState take_exchanges(const SeamMesh& mesh, SeamState state, const DistortionBound& bound, const MapSeams& map,
                         const MapSeams& map_fully, const Deadline& deadline, double least_saving,
                         const std::function<std::vector<SeamExchange>(const SeamState&)>& find);

}  // namespace papilla::param_detail
