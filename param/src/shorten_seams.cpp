// SPDX-License-Identifier: MIT
#include "shorten_seams.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "papilla/core/union_find.hpp"
#include "seam_paths.hpp"

namespace papilla::param_detail {
namespace {

/// What closing a gap δ costs, over δ²: from the tip of a slit, and where two charts are joined.
constexpr double k_of_slit = std::numbers::pi / 4, k_of_joint = 1.5;

/// The part of the energy that is left which one round may take. Where that is too little for any closing, more is
/// tried: what is foreseen is rough.
constexpr double k_share = 0.7, k_next_share = 1.5, k_most_share = 2;

/// A round is worth a map when it would save this fraction of all seams.
constexpr double k_least_saving = 3e-3;
constexpr int k_most_rounds = 30;

/// How far one round's surprise moves what a place is thought to cost, and how far that may go.
constexpr double k_least_surprise = 0.5, k_most_surprise = 1e3, k_after_failure = 8;
constexpr double k_least_doubt = 0.25, k_most_doubt = 1e3;

/// A stretch without a gap costs this part of its length squared: joints of an edge hold little.
constexpr double k_least_gap = 1e-4;

/// A part of a path that may be closed.
struct Closing {
  Index path = 0, first = 0, count = 0;
  double saved = 0;   ///< Cost of its seams.
  double energy = 0;  ///< What it is thought to raise Σ A (e - 4) by.

  bool operator==(const Closing& other) const {
    return path == other.path && first == other.first && count == other.count;
  }
};

/// Those of one path, of which one may be taken.
using Choices = std::vector<Closing>;

class Shortener {
 public:
  Shortener(const SeamMesh& mesh, SeamState state, const DistortionBound& bound, const MapSeams& map,
            std::vector<double>& doubt, const Deadline& deadline, int most_failures)
      : mesh_(mesh),
        state_(std::move(state)),
        bound_(bound),
        map_(map),
        deadline_(deadline),
        doubt_(doubt),
        most_failures_(most_failures) {}

  SeamState run() {
    double share = k_share;
    std::vector<Closing> refused;
    for (int round = 0, failures = 0; round < k_most_rounds && failures < most_failures_ && !deadline_.passed();) {
      const std::vector<SeamPath> paths = seam_paths(mesh_, state_.seam);
      const std::vector<Closing> taken = choose(paths, share * energy_left());
      double saved = 0;
      for (const Closing& c : taken) saved += c.saved;
      if (!(saved > k_least_saving * state_.cost_mm)) {
        if (share >= k_most_share) break;
        share *= k_next_share;
        continue;
      }
      if (taken == refused) {
        distrust(paths, taken, k_after_failure);
        ++failures;
        continue;
      }
      ++round;
      SeamState next = close(paths, taken);
      learn(paths, taken, next);
      if (next.valid && next.distortion <= bound_.most + k_bound_slack && next.cost_mm < state_.cost_mm) {
        state_ = std::move(next);
        share = k_share;
        refused.clear();
      } else {
        share *= 0.5;
        ++failures;
        refused = taken;
      }
    }
    return std::move(state_);
  }

 private:
  /// Until the bound, by how far the distortion is from it.
  double energy_left() const {
    const double now = std::max(state_.distortion - 4, 1e-12), most = bound_.most - 4;
    const double slack = 0.5 * k_bound_slack * mesh_.area;
    return std::max(0.0, (most / now - 1) * std::max(state_.energy, 1e-12 * mesh_.area)) + slack;
  }

  Vec2 left(const SeamPath& path, std::size_t i) const {
    return i < path.halfedges.size() ? state_.uv(path.halfedges[i]) : state_.uv_at_end(path.halfedges.back());
  }
  Vec2 right(const SeamPath& path, std::size_t i) const {
    return i < path.halfedges.size() ? state_.uv_at_end(mesh_.opposite[path.halfedges[i]])
                                     : state_.uv(mesh_.opposite[path.halfedges.back()]);
  }

  double energy_of(const SeamPath& path, std::size_t first, std::size_t count, double factor, double gap2) const {
    double doubt = 0, length = 0;
    for (std::size_t i = first; i < first + count; ++i) {
      doubt = std::max(doubt, doubt_[path.halfedges[i]]);
      length += mesh_.length(path.halfedges[i]);
    }
    return doubt * std::max(factor * gap2, k_least_gap * length * length * (state_.energy / mesh_.area));
  }

  /// Closing from the tip at one end, by every length.
  void add_slit(Index p, const SeamPath& path, bool from_end, bool whole, Choices& choices) const {
    const std::size_t n = path.halfedges.size(), most = whole ? n : n < 3 ? 0 : n - 2;
    double saved = 0, gap2 = 0, doubt = 0, length = 0;
    for (std::size_t count = 1; count <= most; ++count) {
      const std::size_t i = from_end ? n - count : count - 1, end = from_end ? i : i + 1;
      const Index h = path.halfedges[i];
      const Vec2 gap = left(path, end) - right(path, end);
      saved += mesh_.cost[h];
      length += mesh_.length(h);
      doubt = std::max(doubt, doubt_[h]);
      gap2 = std::max(gap2, dot(gap, gap));
      const double least = k_least_gap * length * length * (state_.energy / mesh_.area);
      choices.push_back({p, static_cast<Index>(from_end ? n - count : 0), static_cast<Index>(count), saved,
                         doubt * std::max(k_of_slit * gap2, least)});
    }
  }

  /// The largest gap, squared, that is left over a stretch when its right side is laid against the left.
  double joint_gap(const SeamPath& path, std::size_t first, std::size_t count) const {
    Vec2 p, q;
    const double weight = 1 / static_cast<double>(count + 1);
    for (std::size_t i = first; i <= first + count; ++i)
      p = p + weight * left(path, i), q = q + weight * right(path, i);
    double along = 0, across = 0;
    for (std::size_t i = first; i <= first + count; ++i) {
      const Vec2 x = left(path, i) - p, y = right(path, i) - q;
      along += dot(y, x);
      across += cross(y, x);
    }
    const double size = std::hypot(along, across);
    if (!(size > 0)) return std::numeric_limits<double>::infinity();
    const double c = along / size, s = across / size;
    double most = 0;
    for (std::size_t i = first; i <= first + count; ++i) {
      const Vec2 x = left(path, i) - p, y = right(path, i) - q;
      const Vec2 gap = x - Vec2{c * y.x - s * y.y, s * y.x + c * y.y};
      most = std::max(most, dot(gap, gap));
    }
    return most;
  }

  /// Joining two charts over the whole stretch, halves of it, and so on.
  void add_joints(Index p, const SeamPath& path, Choices& choices) const {
    const std::size_t n = path.halfedges.size();
    const bool loop = mesh_.from(path.halfedges.front()) == mesh_.to(path.halfedges.back());
    for (std::size_t count = loop ? n - 1 : n; count > 0; count /= 2) {
      const std::size_t step = std::max<std::size_t>(1, count / 2);
      for (std::size_t first = 0; first + count <= n; first += step) {
        double saved = 0;
        for (std::size_t i = first; i < first + count; ++i) saved += mesh_.cost[path.halfedges[i]];
        choices.push_back({p, static_cast<Index>(first), static_cast<Index>(count), saved,
                           energy_of(path, first, count, k_of_joint, joint_gap(path, first, count))});
      }
    }
  }

  std::vector<Choices> all_choices(const std::vector<SeamPath>& paths) const {
    std::vector<std::size_t> border(state_.charted.flattening.charts.count, 0);
    for (Index h = 0; h < state_.seam.size(); ++h) border[state_.chart(h)] += state_.seam[h];
    std::vector<Choices> all;
    for (Index p = 0; p < paths.size(); ++p) {
      const SeamPath& path = paths[p];
      const Index h = path.halfedges.front();
      const std::uint32_t a = state_.chart(h), b = state_.chart(mesh_.opposite[h]);
      Choices choices;
      // A slit that is the only border of its chart stays open.
      const bool whole = !(path.tip_at_start && path.tip_at_end) || border[a] > 2 * path.halfedges.size();
      if (path.tip_at_start) add_slit(p, path, false, whole, choices);
      if (path.tip_at_end) add_slit(p, path, true, whole, choices);
      if (a != b) add_joints(p, path, choices);
      if (!choices.empty()) all.push_back(std::move(choices));
    }
    return all;
  }

  /// What saves most for an energy: of each path that part whose saving at a common price is largest.
  std::vector<Closing> choose(const std::vector<SeamPath>& paths, double energy) const {
    const std::vector<Choices> all = all_choices(paths);
    const auto at_price = [&](double price) {
      std::vector<std::pair<double, Closing>> best;
      double sum = 0;
      for (const Choices& choices : all) {
        const Closing* chosen = nullptr;
        double most = 0;
        for (const Closing& c : choices)
          if (const double value = price * c.saved - c.energy; value > most) most = value, chosen = &c;
        if (!chosen) continue;
        best.emplace_back(most, *chosen);
        sum += chosen->energy;
      }
      return std::pair(sum, std::move(best));
    };
    double low = 1e-12 * std::sqrt(mesh_.area), high = 1e6 * std::sqrt(mesh_.area);
    auto chosen = at_price(high);
    if (chosen.first > energy) {
      constexpr int k_bisections = 60;
      for (int i = 0; i < k_bisections; ++i) {
        const double price = std::sqrt(low * high);
        (at_price(price).first > energy ? high : low) = price;
      }
      chosen = at_price(low);
    }
    std::stable_sort(chosen.second.begin(), chosen.second.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    UnionFind joined(state_.charted.flattening.charts.count);
    std::vector<Closing> taken;
    for (const auto& [value, c] : chosen.second) {
      const Index h = paths[c.path].halfedges[c.first];
      const std::uint32_t a = state_.chart(h), b = state_.chart(mesh_.opposite[h]);
      if (a != b && joined.find(a) == joined.find(b)) continue;  // the union would get a hole
      joined.unite(a, b);
      taken.push_back(c);
    }
    return taken;
  }

  SeamState close(const std::vector<SeamPath>& paths, const std::vector<Closing>& taken) const {
    std::vector<std::uint8_t> seam = state_.seam;
    for (const Closing& c : taken)
      for (Index i = c.first; i < c.first + c.count; ++i) {
        const Index h = paths[c.path].halfedges[i];
        seam[h] = seam[mesh_.opposite[h]] = 0;
      }
    return map_(seam, state_);
  }

  /// Compares what the energy rose by around every closing with what was foreseen.
  void learn(const std::vector<SeamPath>& paths, const std::vector<Closing>& taken, const SeamState& next) {
    std::vector<std::vector<Index>> places;
    for (const Closing& c : taken) {
      const auto begin = paths[c.path].halfedges.begin() + c.first;
      places.emplace_back(begin, begin + c.count);
    }
    const std::vector<double> change = raised_around(mesh_, state_, next, places);
    for (std::size_t c = 0; c < taken.size(); ++c) {
      const SeamPath& path = paths[taken[c].path];
      const double foreseen = std::max(taken[c].energy, 1e-12 * mesh_.area);
      double factor = std::clamp(change[c] / foreseen, k_least_surprise, k_most_surprise);
      // Where no chart is known to have no map, triangles are turned over: their energy tells.
      if (!next.valid && !next.without_map.empty())
        factor = next.without_map[path.halfedges[taken[c].first] / 3] ? k_after_failure : 1;
      distrust(path, factor);
    }
  }

  void distrust(const SeamPath& path, double factor) {
    for (const Index h : path.halfedges)
      for (const Index side : {h, mesh_.opposite[h]})
        doubt_[side] = std::clamp(doubt_[side] * factor, k_least_doubt, k_most_doubt);
  }
  void distrust(const std::vector<SeamPath>& paths, const std::vector<Closing>& taken, double factor) {
    for (const Closing& c : taken) distrust(paths[c.path], factor);
  }

  const SeamMesh& mesh_;
  SeamState state_;
  const DistortionBound& bound_;
  const MapSeams& map_;
  const Deadline& deadline_;
  std::vector<double>& doubt_;
  int most_failures_;
};

}  // namespace

SeamState shorten_seams(const SeamMesh& mesh, SeamState state, const DistortionBound& bound, const MapSeams& map,
                        std::vector<double>& doubt, const Deadline& deadline, int most_failures) {
  return Shortener(mesh, std::move(state), bound, map, doubt, deadline, most_failures).run();
}

}  // namespace papilla::param_detail
