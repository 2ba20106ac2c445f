// SPDX-License-Identifier: MIT
#include "piece_cuts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <utility>

namespace papilla::detail {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();
constexpr int k_max_cuts = 64;
/// Distortion below this fraction of what a seam as long as the piece costs is not worth a look, nor is a cut that
/// gains less: it is within the error of the estimate.
constexpr double k_negligible = 1e-3;
/// From this distortion on a cut may also pay by what it takes off the scale itself: the first of several that are
/// needed may leave some of the surface large, some small, and the variation higher than it was.
constexpr double k_severe = 0.5;
/// Off the ridge of the scale a cut across costs up to this many times as much as on it.
constexpr double k_off_ridge = 8;

/// A cut that is considered: half-edges of the piece and what they cost.
struct Cut {
  std::vector<Index> halfedges;
  double cost = 0;
};

class Reliever {
 public:
  Reliever(const Piece& piece, ChartField& field, const SeamWeights& weights)
      : piece_(piece), field_(field), weights_(weights), border_(piece.vertex_count()), cut_(piece.vertex_count(), 0) {
    for (Index v = 0; v < border_.size(); ++v) border_[v] = piece.on_border(v);
    distance_.assign(border_.size(), k_infinity);
    way_.resize(border_.size());
    branch_.resize(border_.size());
  }

  std::vector<Index> run(double seam_cost) {
    const double price = seam_cost / std::sqrt(piece_.area());
    std::vector<Index> taken;
    for (int i = 0; i < k_max_cuts; ++i) {
      ChartField::Solution before = field_.solution();
      if (before.distortion < k_negligible * seam_cost) break;
      const ChartField::Extremes extremes = field_.extremes();
      std::vector<Cut> cuts;
      if (extremes.largest != k_none) {
        cuts.push_back(slit(extremes.largest));
        cuts.push_back(across(extremes.largest));
      }
      if (extremes.smallest != k_none) cuts.push_back(across(extremes.smallest));
      const Cut* best = nullptr;
      ChartField::Solution with_best;
      double best_gain = k_negligible * seam_cost;
      for (const Cut& cut : cuts) {
        if (cut.halfedges.empty()) continue;
        solve_with(cut);
        double gain = before.distortion - field_.distortion();
        if (before.distortion > k_severe) gain = std::max(gain, 0.25 * (before.squared_scale - field_.squared_scale()));
        gain -= price * cut.cost;
        if (gain > best_gain) best_gain = gain, best = &cut, with_best = field_.solution();
      }
      field_.restore(best ? std::move(with_best) : std::move(before));
      if (!best) break;
      mark(*best, cut_);
      mark(*best, border_);
      taken.insert(taken.end(), best->halfedges.begin(), best->halfedges.end());
    }
    return taken;
  }

 private:
  void mark(const Cut& cut, std::vector<std::uint8_t>& vertex) const {
    for (const Index h : cut.halfedges) vertex[piece_.from(h)] = vertex[piece_.to(h)] = 1;
  }

  void solve_with(const Cut& cut) {
    std::vector<std::uint8_t> all = cut_;
    mark(cut, all);
    field_.solve(all);
  }

  /// Paths of least cost from a vertex, nearest first, until arrived(border vertex) is true.
  template <class Cost, class Arrived>
  void search(Index start, const Cost& cost, const Arrived& arrived) {
    for (const Index v : touched_) distance_[v] = k_infinity;
    touched_.assign(1, start);
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    distance_[start] = 0;
    way_[start] = k_none;
    queue.emplace(0, start);
    while (!queue.empty()) {
      const auto [distance, v] = queue.top();
      queue.pop();
      if (distance > distance_[v]) continue;
      if (v != start && border_[v]) {
        if (arrived(v)) return;
        continue;
      }
      piece_.visit_edges(v, [&](Index h, Index to) {
        const double there = distance + cost(h);
        if (!(there < distance_[to])) return;
        if (distance_[to] == k_infinity) touched_.push_back(to);
        distance_[to] = there;
        way_[to] = h;
        branch_[to] = v == start ? to : branch_[v];
        queue.emplace(there, to);
      });
    }
  }

  void follow(Index v, Cut& cut) const {
    while (way_[v] != k_none) {
      const Index h = way_[v];
      cut.halfedges.push_back(h);
      cut.cost += weights_.cost(piece_.halfedge_of(h));
      v = piece_.from(h) == v ? piece_.to(h) : piece_.from(h);
    }
  }

  Cut slit(Index start) {
    Cut cut;
    if (border_[start]) return cut;
    search(
        start, [&](Index h) { return weights_.cost(piece_.halfedge_of(h)); },
        [&](Index v) {
          follow(v, cut);
          return true;
        });
    return cut;
  }

  Cut across(Index start) {
    Cut cut;
    if (border_[start]) return cut;
    const double extreme = field_.scale(start);
    std::optional<Index> first;
    search(
        start,
        [&](Index h) {
          const double scale = 0.5 * (field_.scale(piece_.from(h)) + field_.scale(piece_.to(h)));
          const double off = std::clamp(1 - scale / extreme, 0.0, 1.0);
          return weights_.cost(piece_.halfedge_of(h)) * (1 + (k_off_ridge - 1) * off);
        },
        [&](Index v) {
          if (!first) {
            first = branch_[v];
            follow(v, cut);
            return false;
          }
          const Vec3& p = piece_.positions[start];
          if (dot(piece_.positions[branch_[v]] - p, piece_.positions[*first] - p) > 0) return false;
          follow(v, cut);
          two_sided_ = true;
          return true;
        });
    if (!std::exchange(two_sided_, false)) cut.halfedges.clear();
    return cut;
  }

  const Piece& piece_;
  ChartField& field_;
  const SeamWeights& weights_;
  std::vector<std::uint8_t> border_, cut_;
  std::vector<double> distance_;
  std::vector<Index> way_, branch_, touched_;
  bool two_sided_ = false;
};

}  // namespace

std::vector<Index> relieve(const Piece& piece, ChartField& field, const SeamWeights& weights, double seam_cost) {
  return Reliever(piece, field, weights).run(seam_cost);
}

}  // namespace papilla::detail
