// SPDX-License-Identifier: MIT
#include "exchange_seams.hpp"

#include <array>
#include <optional>
#include <utility>

#include "lengthen_seams.hpp"

namespace papilla::param_detail {
namespace {

/// Where seams are brought, as a part of what the bound allows of D - 4. Further away other seams come back, and more
/// maps are needed.
constexpr std::array<double, 4> k_away{0.9, 0.75, 0.5, 1.1};

}  // namespace

SeamState exchange_seams(const SeamMesh& mesh, SeamState state, const DistortionBound& bound, const MapSeams& map,
                         const MapSeams& map_fully, const Deadline& deadline) {
  const auto shortened = [&](SeamState from, const DistortionBound& to, const MapSeams& by) {
    std::vector<double> doubt(mesh.opposite.size(), 1);
    return shorten_seams(mesh, std::move(from), to, by, doubt, deadline);
  };
  const auto lengthened = [&](SeamState from, const DistortionBound& to) {
    return lengthen_seams(mesh, std::move(from), to, map_fully, deadline);
  };
  for (const double part : k_away) {
    const DistortionBound away{4 + part * (bound.most - 4), bound.percentile};
    while (!deadline.passed()) {
      std::optional<SeamState> next = part < 1 ? lengthened(state, away) : shortened(state, away, map_fully);
      if (next && next->distortion > bound.most + k_bound_slack) next = lengthened(std::move(*next), bound);
      if (!next) break;
      next = shortened(std::move(*next), bound, map);
      if (!(next->cost_mm < state.cost_mm)) break;
      state = std::move(*next);
    }
  }
  return state;
}

}  // namespace papilla::param_detail
