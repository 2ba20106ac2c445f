// SPDX-License-Identifier: MIT
#include "seam_exchange.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "lengthen_seams.hpp"

namespace papilla::param_detail {
namespace {

/// So many exchanges may fail one after the other.
constexpr std::size_t k_most_failed = 4;

/// A map that exceeds 4 by more than this many times what it may is not brought back.
constexpr double k_near = 2;

/// Strips of width w on a surface of curvature K distort by (K w²)²: seams of twice the length leave a 16th of D - 4,
/// and none do better. Those that were lengthened by a few per cent of D - 4 became dearer by about half as many. An
/// exchange that is dearer by then is not looked into.
constexpr double k_usual_growth = 0.4;

/// Shortening is given up after so many failures where seams are not cheaper by then.
constexpr int k_few_failures = 2;

}  // namespace

SeamState take_exchanges(const SeamMesh& mesh, SeamState state, const DistortionBound& bound, const MapSeams& map,
                         const MapSeams& map_fully, const Deadline& deadline, double least_saving,
                         const std::function<std::vector<SeamExchange>(const SeamState&)>& find) {
  const auto taken = [&](const SeamExchange& exchange) -> std::optional<SeamState> {
    std::vector<std::uint8_t> seam = state.seam;
    for (const Index h : exchange.before) seam[h] = seam[mesh.opposite[h]] = 0;
    for (const Index h : exchange.after) seam[h] = seam[mesh.opposite[h]] = 1;
    std::optional<SeamState> next = map_fully(seam, state);
    const double over = (next->distortion - 4) / (bound.most - 4);
    if (!next->valid || over > k_near) return {};
    if (over > 1 && !(next->cost_mm * std::pow(over, k_usual_growth) < state.cost_mm)) return {};
    if (next->distortion > bound.most + k_bound_slack)
      next = lengthen_seams(mesh, std::move(*next), bound, map_fully, deadline);
    if (!next) return {};
    std::vector<double> doubt(mesh.opposite.size(), 1);
    next = shorten_seams(mesh, std::move(*next), bound, map, doubt, deadline, k_few_failures);
    if (!(next->cost_mm < state.cost_mm)) return {};
    return shorten_seams(mesh, std::move(*next), bound, map, doubt, deadline);
  };
  std::set<std::vector<Index>> failed;  // by what stands after
  for (;;) {
    std::vector<SeamExchange> exchanges = find(state);
    std::erase_if(exchanges, [&](const SeamExchange& exchange) {
      return !(exchange.saved > least_saving * state.cost_mm) || failed.count(exchange.after) > 0;
    });
    std::stable_sort(exchanges.begin(), exchanges.end(),
                     [](const auto& a, const auto& b) { return a.saved > b.saved; });
    std::optional<SeamState> next;
    for (std::size_t i = 0; i < std::min(k_most_failed, exchanges.size()) && !next && !deadline.passed(); ++i) {
      next = taken(exchanges[i]);
      if (!next) failed.insert(std::move(exchanges[i].after));
    }
    if (!next) return state;
    state = std::move(*next);
  }
}

}  // namespace papilla::param_detail
