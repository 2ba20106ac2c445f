// SPDX-License-Identifier: MIT
#include "exchange_seams.hpp"

#include <optional>
#include <utility>

#include "lengthen_seams.hpp"

namespace papilla::param_detail {
namespace {

/// Where seams are brought, as a part of what the bound allows of D - 4. With 0.9 two slits of the same length stay as
/// they are; trying more than one part takes a fifth more time and gains a thousandth of seams.
constexpr double k_away = 0.8;

}  // namespace

SeamState exchange_seams(const SeamMesh& mesh, SeamState state, const DistortionBound& bound, const MapSeams& map,
                         const MapSeams& map_fully, const Deadline& deadline) {
  const DistortionBound away{4 + k_away * (bound.most - 4), bound.percentile};
  while (!deadline.passed()) {
    std::optional<SeamState> next = lengthen_seams(mesh, state, away, map_fully, deadline);
    if (!next) break;
    std::vector<double> doubt(mesh.opposite.size(), 1);
    next = shorten_seams(mesh, std::move(*next), bound, map, doubt, deadline);
    if (!(next->cost_mm < state.cost_mm)) break;
    state = std::move(*next);
  }
  return state;
}

}  // namespace papilla::param_detail
