// SPDX-License-Identifier: MIT
#include "shift_seams.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>

#include "least_cut.hpp"
#include "seam_exchange.hpp"
#include "seam_paths.hpp"

namespace papilla::param_detail {
namespace {

constexpr Index k_none = ~Index{0};

/// Triangles that a stretch may move over on either side are fewer than this many from it.
constexpr int k_depth = 6;

/// What seams are worth, over E / Σ c: D - 4 falls with this power of their length.
constexpr double k_price = 4;

/// Part of what all seams cost that is worth a map.
constexpr double k_least_saving = 0.003;

class Shifter {
 public:
  Shifter(const SeamMesh& mesh, const SeamState& state)
      : mesh_(mesh),
        state_(state),
        paths_(seam_paths(mesh, state.seam)),
        price_(k_price * state.energy / state.cost_mm),
        strips_(paths_.size()),
        place_(mesh.rest.size()),
        path_of_edge_(mesh.opposite.size(), k_none),
        within_(mesh.on_border.size(), k_none) {
    for (std::size_t v = 0; v < within_.size(); ++v)
      if (mesh.on_border[v]) within_[v] = k_end;
    for (Index p = 0; p < paths_.size(); ++p) {
      const std::vector<Index>& way = paths_[p].halfedges;
      for (const Index h : way) path_of_edge_[h] = path_of_edge_[mesh.opposite[h]] = p;
      for (std::size_t i = 1; i < way.size(); ++i) within_[mesh.from(way[i])] = p;
      within_[start(p)] = within_[end(p)] = k_end;
    }
    spread();
  }

  std::vector<SeamExchange> exchanges() const {
    std::vector<SeamExchange> all;
    SeamExchange together;
    for (Index p = 0; p < paths_.size(); ++p) {
      SeamExchange exchange = shifted(p);
      if (!(exchange.saved > 0)) continue;
      together.before.insert(together.before.end(), exchange.before.begin(), exchange.before.end());
      together.after.insert(together.after.end(), exchange.after.begin(), exchange.after.end());
      together.saved += exchange.saved;
      all.push_back(std::move(exchange));
    }
    if (all.size() > 1) all.push_back(std::move(together));
    return all;
  }

 private:
  static constexpr Index k_end = k_none - 1;

  /// The stretch that a triangle lies beside, on which side, the edge of it that is nearest, and its place in the
  /// strip.
  struct Place {
    Index path = k_none, edge = 0, item = 0;
    bool is_right = false;

    bool is_beside(const Place& other) const { return path == other.path && is_right == other.is_right; }
  };

  /// Two triangles of a strip, beside each other over an edge that is a seam or may become one.
  struct Joint {
    Index halfedge = 0, a = 0, b = 0;  ///< Items.
    bool is_seam = false;
  };

  Index start(Index p) const { return mesh_.from(paths_[p].halfedges.front()); }
  Index end(Index p) const { return mesh_.to(paths_[p].halfedges.back()); }

  /// Gives triangles to the stretch that they are nearest to, over edges that are no seams.
  void spread() {
    std::vector<std::pair<Index, Place>> front, next;
    for (Index p = 0; p < paths_.size(); ++p)
      for (Index i = 0; i < paths_[p].halfedges.size(); ++i) {
        const Index h = paths_[p].halfedges[i];
        front.push_back({h / 3, {p, i, 0, false}});
        front.push_back({mesh_.opposite[h] / 3, {p, i, 0, true}});
      }
    for (int depth = 0; depth < k_depth; ++depth) {
      next.clear();
      for (auto [t, place] : front) {
        if (place_[t].path != k_none) continue;
        place.item = static_cast<Index>(strips_[place.path].size());
        place_[t] = place;
        strips_[place.path].push_back(t);
        for (Index h = 3 * t; h < 3 * t + 3; ++h)
          if (!state_.seam[h]) next.push_back({mesh_.opposite[h] / 3, place});
      }
      std::swap(front, next);
    }
  }

  /// Whether a triangle keeps its side: it touches another stretch, or is at the rim of the strip.
  bool is_fixed(Index t) const {
    const Place& place = place_[t];
    for (Index h = 3 * t; h < 3 * t + 3; ++h) {
      const Index v = mesh_.from(h);
      if (within_[v] != k_none && within_[v] != place.path && v != start(place.path) && v != end(place.path))
        return true;
      if (mesh_.opposite[h] == k_no_triangle || (state_.seam[h] && path_of_edge_[h] != place.path)) return true;
      const Place& other = place_[mesh_.opposite[h] / 3];
      if (other.path != place.path || (other.is_right != place.is_right) != bool(state_.seam[h])) return true;
    }
    return false;
  }

  /// e - 4 beside each edge of a stretch, left and right: the mean over the triangles that touch the stretch and are
  /// nearest to that edge or one of its neighbours, or the next ones where these have none.
  std::array<std::vector<double>, 2> densities(Index p) const {
    const std::size_t edges = paths_[p].halfedges.size();
    std::array<std::vector<double>, 2> energy{}, area{}, density{};
    for (const int side : {0, 1}) energy[side].resize(edges), area[side].resize(edges), density[side].resize(edges);
    for (const Index t : strips_[p]) {
      const Triangle& corners = mesh_.mesh.triangles[t];
      if (std::all_of(corners.begin(), corners.end(), [&](Index v) { return within_[v] == k_none; })) continue;
      const Place& place = place_[t];
      energy[place.is_right][place.edge] += state_.excess[t];
      area[place.is_right][place.edge] += mesh_.rest[t].area;
    }
    for (const int side : {0, 1})
      for (std::size_t i = 0; i < edges; ++i) {
        double e = energy[side][i], a = area[side][i];
        for (std::size_t far = 1; far < edges && (far == 1 || !(a > 0)); ++far) {
          if (i >= far) e += energy[side][i - far], a += area[side][i - far];
          if (i + far < edges) e += energy[side][i + far], a += area[side][i + far];
        }
        density[side][i] = a > 0 ? e / a : 0;
      }
    return density;
  }

  std::vector<Joint> joints(Index p) const {
    std::vector<Joint> all;
    for (const Index t : strips_[p])
      for (Index h = 3 * t; h < 3 * t + 3; ++h) {
        if (mesh_.opposite[h] == k_no_triangle || (state_.seam[h] && path_of_edge_[h] != p)) continue;
        const Place &place = place_[t], &other = place_[mesh_.opposite[h] / 3];
        if (other.path != p || other.item < place.item) continue;
        const bool is_seam = state_.seam[h];
        if (is_seam || other.is_right == place.is_right) all.push_back({h, place.item, other.item, is_seam});
      }
    return all;
  }

  /// Where a stretch costs least, counted with the energy. @return nothing saved: where it is.
  SeamExchange shifted(Index p) const {
    constexpr double k_never = std::numeric_limits<double>::infinity();
    const std::vector<Index>& strip = strips_[p];
    const auto density = densities(p);
    std::vector<LabelCost> items;
    bool is_free = false;
    for (const Index t : strip) {
      const Place& place = place_[t];
      double other = k_never;
      if (!is_fixed(t)) {
        other = mesh_.rest[t].area * density[!place.is_right][place.edge] - state_.excess[t];
        is_free = true;
      }
      items.push_back(place.is_right ? LabelCost{other, 0} : LabelCost{0, other});
    }
    SeamExchange exchange;
    if (!is_free) return exchange;
    const std::vector<Joint> edges = joints(p);
    std::vector<LabelPair> pairs;
    for (const Joint& edge : edges) pairs.push_back({edge.a, edge.b, price_ * mesh_.cost[edge.halfedge]});
    const std::vector<char> is_right = least_cut(items, pairs);
    double gain = 0;
    for (std::size_t i = 0; i < items.size(); ++i)
      if (bool(is_right[i]) != place_[strip[i]].is_right) gain -= is_right[i] ? items[i].second : items[i].first;
    for (const Joint& edge : edges) {
      const bool is_seam = is_right[edge.a] != is_right[edge.b];
      if (is_seam == edge.is_seam) continue;
      (is_seam ? exchange.after : exchange.before).push_back(edge.halfedge);
      gain += (is_seam ? -1 : 1) * price_ * mesh_.cost[edge.halfedge];
    }
    if (!exchange.after.empty() && leaves_one_way(p, exchange)) exchange.saved = gain / price_;
    return exchange;
  }

  /// Whether a stretch is one way between its ends after an exchange, that passes no vertex twice.
  bool leaves_one_way(Index p, const SeamExchange& exchange) const {
    std::vector<std::pair<Index, Index>> ends;  // of each edge, both ways, by the vertex that it leaves
    const auto add = [&](Index h) {
      ends.emplace_back(mesh_.from(h), mesh_.to(h));
      ends.emplace_back(mesh_.to(h), mesh_.from(h));
    };
    std::vector<Index> gone = exchange.before;
    for (const Index h : exchange.before) gone.push_back(mesh_.opposite[h]);
    std::sort(gone.begin(), gone.end());
    for (const Index h : paths_[p].halfedges)
      if (!std::binary_search(gone.begin(), gone.end(), h)) add(h);
    for (const Index h : exchange.after) add(h);
    std::sort(ends.begin(), ends.end());
    const auto from = [&](Index v) {
      const auto first = std::lower_bound(ends.begin(), ends.end(), std::pair<Index, Index>(v, 0));
      const auto last = std::find_if(first, ends.end(), [&](const auto& e) { return e.first != v; });
      return std::pair(first, last);
    };
    std::size_t passed = 0;
    Index v = start(p), before = k_none;
    do {
      const auto [first, last] = from(v);
      if (last - first != (before == k_none ? 1 : 2)) return false;
      const Index next = first->second != before ? first->second : (last - 1)->second;
      before = std::exchange(v, next);
      ++passed;
    } while (v != end(p) && 2 * passed < ends.size());
    return v == end(p) && 2 * passed == ends.size();
  }

  const SeamMesh& mesh_;
  const SeamState& state_;
  std::vector<SeamPath> paths_;
  double price_;
  std::vector<std::vector<Index>> strips_;  ///< Triangles, per stretch.
  std::vector<Place> place_;                ///< Per triangle.
  std::vector<Index> path_of_edge_;         ///< Per half-edge; k_none: no seam.
  std::vector<Index> within_;  ///< Per vertex: the stretch that passes it, k_end where some end or on borders.
};

}  // namespace

SeamState shift_seams(const SeamMesh& mesh, SeamState state, const DistortionBound& bound, const MapSeams& map,
                      const MapSeams& map_fully, const Deadline& deadline) {
  if (!(state.energy > 0 && state.cost_mm > 0)) return state;
  return take_exchanges(mesh, std::move(state), bound, map, map_fully, deadline, k_least_saving,
                        [&](const SeamState& of) { return Shifter(mesh, of).exchanges(); });
}

}  // namespace papilla::param_detail
