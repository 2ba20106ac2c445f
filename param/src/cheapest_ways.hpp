// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "outgoing_edges.hpp"

namespace papilla::param_detail {

/// Cheapest ways over the edges of a mesh from the nearest of some vertices (Dijkstra). What one search found is known
/// until the next. Memory O(n), once; a search costs O(k log k) for the k vertices that it reaches.
class CheapestWays {
 public:
  static constexpr Index k_none = ~Index{0};

  explicit CheapestWays(const SeamMesh& mesh)
      : mesh_(mesh),
        edges_(mesh),
        cost_(mesh.on_border.size(), std::numeric_limits<double>::infinity()),
        way_(mesh.on_border.size(), k_none) {}

  /// @param cost of a half-edge, not negative. @param may (vertex, cost of the way to it): whether a way may go there.
  /// @param is_goal (vertex): the search ends there. @return the cheapest goal, or k_none.
  template <class Cost, class May, class IsGoal>
  Index search(std::span<const Index> from, Cost cost, May may, IsGoal is_goal) {
    for (const Index v : touched_) cost_[v] = std::numeric_limits<double>::infinity(), way_[v] = k_none;
    touched_.clear();
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const Index v : from)
      if (cost_[v] > 0) cost_[v] = 0, touched_.push_back(v), queue.emplace(0, v);
    while (!queue.empty()) {
      const auto [there, v] = queue.top();
      queue.pop();
      if (there > cost_[v]) continue;
      if (is_goal(v)) return v;
      for (const Index h : edges_.of(v)) {
        const Index to = mesh_.to(h);
        const double next = there + cost(h);
        if (!(next < cost_[to]) || !may(to, next)) continue;
        if (way_[to] == k_none && cost_[to] > 0) touched_.push_back(to);
        cost_[to] = next;
        way_[to] = h;
        queue.emplace(next, to);
      }
    }
    return k_none;
  }

  bool has_reached(Index v) const { return cost_[v] < std::numeric_limits<double>::infinity(); }

  double cost(Index v) const { return cost_[v]; }

  /// The half-edges to a vertex that was reached, in order.
  std::vector<Index> way_to(Index v) const {
    std::vector<Index> way;
    for (; way_[v] != k_none; v = mesh_.from(way_[v])) way.push_back(way_[v]);
    std::reverse(way.begin(), way.end());
    return way;
  }

 private:
  const SeamMesh& mesh_;
  OutgoingEdges edges_;
  std::vector<double> cost_;
  std::vector<Index> way_, touched_;
};

}  // namespace papilla::param_detail
