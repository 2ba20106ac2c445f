// SPDX-License-Identifier: MIT
#include "piece_cuts.hpp"

#include <algorithm>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

namespace papilla::detail {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();
/// A cut ends on the border where the distance to the nearer end is at least this share of the sum of both.
constexpr double k_least_share = 0.3;

/// Distances between the centroids of neighbouring triangles.
struct Steps {
  std::vector<double> over;  ///< Per half-edge; 0 on borders.
  double mean = 0;
};

Steps steps_of(const Piece& piece) {
  std::vector<Vec3> middle;
  middle.reserve(piece.size());
  for (const Triangle& c : piece.triangles)
    middle.push_back((1.0 / 3) * (piece.positions[c[0]] + piece.positions[c[1]] + piece.positions[c[2]]));
  Steps steps{std::vector<double>(piece.opposite.size(), 0)};
  for (Index h = 0; h < steps.over.size(); ++h) {
    if (piece.opposite[h] == k_none) continue;
    steps.over[h] = norm(middle[triangle_of(piece.opposite[h])] - middle[triangle_of(h)]);
    steps.mean += steps.over[h];
  }
  steps.mean /= static_cast<double>(std::max(steps.over.size(), std::size_t{1}));
  return steps;
}

/// Distances over the triangles from sources, and which source is nearest.
struct Growth {
  std::vector<double> distance;
  std::vector<Index> source;
};

/// Shortest paths without a sorted queue: what is nearer than a limit goes on in any order, and again when it turns out
/// to be nearer still; then the limit rises. The distances are those of Dijkstra's order, to the last bit.
Growth grow(const Piece& piece, const Steps& steps, const std::vector<Index>& sources) {
  constexpr double k_steps_at_once = 3;
  Growth growth{std::vector<double>(piece.size(), k_infinity), std::vector<Index>(piece.size(), k_none)};
  for (Index s = 0; s < sources.size(); ++s) {
    growth.distance[sources[s]] = 0;
    growth.source[sources[s]] = s;
  }
  std::vector<Index> near = sources, far;
  double limit = k_steps_at_once * steps.mean;
  while (!near.empty()) {
    for (std::size_t i = 0; i < near.size(); ++i) {
      const Index t = near[i];
      for (Index h = 3 * t; h < 3 * t + 3; ++h) {
        if (piece.opposite[h] == k_none) continue;
        const Index other = triangle_of(piece.opposite[h]);
        const double there = growth.distance[t] + steps.over[h];
        if (!(there < growth.distance[other])) continue;
        // Beyond the limit it waits already, unless nothing led there.
        if (there <= limit)
          near.push_back(other);
        else if (growth.distance[other] == k_infinity)
          far.push_back(other);
        growth.distance[other] = there;
        growth.source[other] = growth.source[t];
      }
    }
    near.clear();
    std::erase_if(far, [&](Index t) { return growth.distance[t] <= limit; });
    double nearest = k_infinity;
    for (const Index t : far) nearest = std::min(nearest, growth.distance[t]);
    limit = nearest + k_steps_at_once * steps.mean;
    for (const Index t : far)
      if (growth.distance[t] <= limit) near.push_back(t);
  }
  return growth;
}

/// The cut of least cost from one side of the outer border to the other, between its two ends. Empty when there is
/// none.
class Crossing {
 public:
  Crossing(const Piece& piece, const SeamWeights& weights) : piece_(piece), weights_(weights) {}

  std::vector<Index> run(const std::vector<double>& from_a, const std::vector<double>& from_b) {
    const auto loops = border_loops(piece_);
    if (loops.empty()) return {};
    mark_sides(loops.front(), from_a, from_b);
    free_.assign(piece_.opposite.size(), 0);
    for (std::size_t l = 1; l < loops.size(); ++l)
      for (const Index h : loops[l]) free_[h] = 1;
    return search();
  }

 private:
  /// The border runs from end a to end b and back: sides 1 and 2, where a cut may end; 3 elsewhere on the outer border.
  void mark_sides(const std::vector<Index>& outer, const std::vector<double>& from_a,
                  const std::vector<double>& from_b) {
    const auto nearest = [&](const std::vector<double>& distance) {
      return static_cast<std::size_t>(
          std::min_element(outer.begin(), outer.end(),
                           [&](Index g, Index h) { return distance[g / 3] < distance[h / 3]; }) -
          outer.begin());
    };
    const std::size_t a = nearest(from_a), b = nearest(from_b), n = outer.size();
    side_.assign(piece_.vertex_count(), 0);
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t k = (a + i) % n;
      const double p = from_a[outer[k] / 3], q = from_b[outer[k] / 3];
      const std::uint8_t side = i < (b + n - a) % n ? 1 : 2;
      side_[piece_.from(outer[k])] = std::min(p, q) < k_least_share * (p + q) ? 3 : side;
    }
  }

  std::vector<Index> search() const {
    std::vector<double> distance(piece_.vertex_count(), k_infinity);
    std::vector<Index> way(piece_.vertex_count(), k_none);
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (Index v = 0; v < side_.size(); ++v)
      if (side_[v] == 1) distance[v] = 0, queue.emplace(0, v);
    while (!queue.empty()) {
      const auto [there, v] = queue.top();
      queue.pop();
      if (there > distance[v]) continue;
      if (side_[v] == 2) return path_to(v, way);
      if (side_[v] != 0 && there > 0) continue;  // along the border leads nowhere
      piece_.visit_edges(v, [&](Index h, Index to) {
        if (piece_.opposite[h] == k_none && !free_[h]) return;
        const double next = there + (free_[h] ? 0 : weights_.cost(piece_.halfedge_of(h)));
        if (!(next < distance[to])) return;
        distance[to] = next;
        way[to] = h;
        queue.emplace(next, to);
      });
    }
    return {};
  }

  std::vector<Index> path_to(Index v, const std::vector<Index>& way) const {
    std::vector<Index> cuts;
    while (way[v] != k_none) {
      const Index h = way[v];
      if (piece_.opposite[h] != k_none) cuts.push_back(h);
      v = piece_.from(h) == v ? piece_.to(h) : piece_.from(h);
    }
    return cuts;
  }

  const Piece& piece_;
  const SeamWeights& weights_;
  std::vector<std::uint8_t> side_;  ///< Per vertex: 0 within and on holes, else its side of the outer border.
  std::vector<std::uint8_t> free_;  ///< Per half-edge: on a hole, where a cut costs nothing.
};

/// The least costly cut between two triangles, or that at equal distances from them.
std::vector<Index> cut_between(const Piece& piece, const Steps& steps, const SeamWeights& weights, Index a,
                               const Growth& from_a, Index b) {
  std::vector<Index> cuts = Crossing(piece, weights).run(from_a.distance, grow(piece, steps, {b}).distance);
  if (!cuts.empty()) return cuts;
  const Growth halves = grow(piece, steps, {a, b});
  for (Index h = 0; h < piece.opposite.size(); ++h) {
    const Index other = piece.opposite[h];
    if (other != k_none && h < other && halves.source[h / 3] != halves.source[other / 3]) cuts.push_back(h);
  }
  return cuts;
}

}  // namespace

std::vector<Index> cut_in_halves(const Piece& piece, const SeamWeights& weights) {
  const auto farthest = [](const Growth& growth) {
    return static_cast<Index>(std::max_element(growth.distance.begin(), growth.distance.end()) -
                              growth.distance.begin());
  };
  const Steps steps = steps_of(piece);
  const Index a = farthest(grow(piece, steps, {0}));
  const Growth from_a = grow(piece, steps, {a});
  Index b = farthest(from_a);
  if (a == b) b = a == 0 ? 1 : 0;  // all triangles in one place
  return cut_between(piece, steps, weights, a, from_a, b);
}

std::vector<Index> cut_apart(const Piece& piece, const SeamWeights& weights, Index a, Index b) {
  const Steps steps = steps_of(piece);
  return cut_between(piece, steps, weights, a, grow(piece, steps, {a}), b);
}

}  // namespace papilla::detail
