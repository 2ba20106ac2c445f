// SPDX-License-Identifier: MIT
#include "reconnect_seams.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "cheapest_ways.hpp"
#include "papilla/core/union_find.hpp"
#include "seam_exchange.hpp"
#include "seam_paths.hpp"

namespace papilla::param_detail {
namespace {

/// Part of what all seams cost that is worth a map.
constexpr double k_least_saving = 0.003;

class Reconnector {
 public:
  Reconnector(const SeamMesh& mesh, const SeamState& state)
      : mesh_(mesh), state_(state), paths_(seam_paths(mesh, state.seam)), ways_(mesh) {}

  std::vector<SeamExchange> exchanges() {
    std::vector<SeamExchange> all;
    for (Index p = 0; p < paths_.size(); ++p)
      for (const bool from_end : {false, true})
        if (auto exchange = exchange_of(p, from_end)) all.push_back(std::move(*exchange));
    return all;
  }

 private:
  /// What is joined to the start of a path (or to its end) is joined to another place of the path, or of what is joined
  /// to its other end.
  std::optional<SeamExchange> exchange_of(Index p, bool from_end) {
    const SeamPath& path = paths_[p];
    const Index front = path.halfedges.front();
    const bool starts_at_tip = from_end ? path.tip_at_end : path.tip_at_start;
    if (starts_at_tip || state_.chart(front) != state_.chart(mesh_.opposite[front])) return {};
    std::vector<Index> halfedges = path.halfedges;
    if (from_end) {
      std::reverse(halfedges.begin(), halfedges.end());
      for (Index& h : halfedges) h = mesh_.opposite[h];
    }
    UnionFind pieces = pieces_without(p);
    const Index one = pieces.find(mesh_.from(halfedges.front())), other = pieces.find(mesh_.to(halfedges.back()));
    if (one == other) return {};

    // Of vertices that may be joined to: how many edges of the path lie before them, and what these cost.
    const auto vertices = static_cast<Index>(mesh_.on_border.size());
    std::vector<Index> place(vertices, 0);
    std::vector<double> before(vertices, 0);
    double whole = 0;
    for (Index i = 0; i < halfedges.size(); ++i) {
      whole += mesh_.cost[halfedges[i]];
      place[mesh_.to(halfedges[i])] = i + 1;
      before[mesh_.to(halfedges[i])] = whole;
    }
    std::vector<Index> from;
    for (Index v = 0; v < vertices; ++v) {
      if (!on_seam_[v]) continue;
      if (pieces.find(v) == one) from.push_back(v);
      if (pieces.find(v) == other) place[v] = static_cast<Index>(halfedges.size()), before[v] = whole;
    }
    ways_.search(
        from, [&](Index h) { return mesh_.cost[h]; },
        [&](Index v, double cost) { return cost < whole && (!on_seam_[v] || pieces.find(v) == other); },
        [](Index) { return false; });
    Index goal = CheapestWays::k_none;
    const double least = k_least_saving * state_.cost_mm;
    double most = least;
    for (Index v = 0; v < vertices; ++v)
      if (place[v] > 0 && ways_.has_reached(v) && before[v] - ways_.cost(v) > most)
        most = before[v] - ways_.cost(v), goal = v;
    if (goal == CheapestWays::k_none) return {};

    SeamExchange exchange{{}, {}, most};
    for (double gone = 0; !(gone > ways_.cost(goal) + least); gone += mesh_.cost[exchange.before.back()])
      exchange.before.push_back(halfedges[exchange.before.size()]);
    for (const Index h : ways_.way_to(goal)) {
      exchange.after.push_back(h);
      if (place[mesh_.to(h)] >= exchange.before.size()) break;
    }
    return exchange;
  }

  /// Vertices that seams and borders join when a path is left out; on_seam_ has those that lie on any of them.
  UnionFind pieces_without(Index left_out) {
    UnionFind pieces(mesh_.on_border.size());
    on_seam_ = mesh_.on_border;
    for (Index h = 0; h < mesh_.opposite.size(); ++h)
      if (mesh_.opposite[h] == k_no_triangle) pieces.unite(mesh_.from(h), mesh_.to(h));
    for (Index p = 0; p < paths_.size(); ++p) {
      if (p == left_out) continue;
      for (const Index h : paths_[p].halfedges) {
        pieces.unite(mesh_.from(h), mesh_.to(h));
        on_seam_[mesh_.from(h)] = on_seam_[mesh_.to(h)] = 1;
      }
    }
    return pieces;
  }

  const SeamMesh& mesh_;
  const SeamState& state_;
  std::vector<SeamPath> paths_;
  CheapestWays ways_;
  std::vector<char> on_seam_;
};

}  // namespace

SeamState reconnect_seams(const SeamMesh& mesh, SeamState state, const DistortionBound& bound, const MapSeams& map,
                          const MapSeams& map_fully, const Deadline& deadline) {
  return take_exchanges(mesh, std::move(state), bound, map, map_fully, deadline, k_least_saving,
                        [&](const SeamState& of) { return Reconnector(mesh, of).exchanges(); });
}

}  // namespace papilla::param_detail
