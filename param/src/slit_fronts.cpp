// SPDX-License-Identifier: MIT
#include "slit_fronts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "seam_paths.hpp"

namespace papilla::param_detail {
namespace {

constexpr Index k_none = ~Index{0};

/// Edges behind a tip over which its opening is looked at, and the part of its length that a slit grows by at most.
constexpr std::size_t k_behind = 3;
constexpr double k_most_growth = 0.5;

/// k of new slits, the most of √(area) that they go, how many there are of them at most, and the part of its mean to
/// which the tension may fall: what is released per length is greatest there.
constexpr double k_of_new = 8, k_most_length = 0.5, k_least_tension = 0.5;
constexpr std::size_t k_most_new = 8;

/// How nearly an edge has to run in the direction of a slit: the cosine of the angle between them, of one that runs on
/// and of a new one.
constexpr double k_least_cosine = 0, k_least_cosine_of_new = 0.5;

Vec2 left_of(Vec2 v) { return {-v.y, v.x}; }

/// A vector of length 1; of zero: zero.
Vec2 unit(Vec2 v) {
  const double length = norm(v);
  return length > 0 ? (1 / length) * v : Vec2{};
}

/// (1 - (J Jᵀ)⁻¹) / 2 of a map, by its axes: positive where the map is longer than the surface.
struct Strain {
  double uu = 0, uv = 0, vv = 0;

  double along(Vec2 d) const { return uu * d.x * d.x + 2 * uv * d.x * d.y + vv * d.y * d.y; }

  /// Across the greatest tension; zero where all are the same.
  Vec2 across_greatest() const {
    const double half = 0.5 * (uu - vv);
    if (!(std::hypot(half, uv) > 0)) return {};
    const double angle = 0.5 * std::atan2(uv, half);
    return {-std::sin(angle), std::cos(angle)};
  }
};

Strain strain_of(const RestShape& rest, Vec2 a, Vec2 b, Vec2 c) {
  const Jacobian j = jacobian(rest, b - a, c - a);
  const double uu = j.x.x * j.x.x + j.y.x * j.y.x, vv = j.x.y * j.x.y + j.y.y * j.y.y;
  const double uv = j.x.x * j.x.y + j.y.x * j.y.y, determinant = uu * vv - uv * uv;
  if (!(determinant > 0)) return {};
  return {0.5 * (1 - vv / determinant), 0.5 * uv / determinant, 0.5 * (1 - uu / determinant)};
}

class FrontFinder {
 public:
  FrontFinder(const SeamMesh& mesh, const OutgoingEdges& edges, const SeamState& state)
      : mesh_(mesh), edges_(edges), state_(state), is_blocked_(mesh.on_border), paths_(seam_paths(mesh, state.seam)) {
    for (const SeamPath& path : paths_)
      for (const Index h : path.halfedges) is_blocked_[mesh.from(h)] = is_blocked_[mesh.to(h)] = 1;
  }

  void add_tips(std::vector<SlitFront>& fronts) {
    for (const SeamPath& path : paths_)
      for (const bool at_end : {false, true})
        if (at_end ? path.tip_at_end : path.tip_at_start)
          if (SlitFront front = of_tip(path, at_end); !front.way.empty()) fronts.push_back(std::move(front));
  }

  void add_new(std::vector<SlitFront>& fronts) {
    find_strains();
    std::vector<SlitFront> all;
    for (Index h = 0; h < state_.seam.size(); ++h)
      if (state_.seam[h])
        if (SlitFront front = from_border(h); !front.way.empty()) all.push_back(std::move(front));
    std::vector<double> per_cost(all.size());
    std::vector<std::size_t> order(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      double cost = 0;
      for (const Index h : all[i].way) cost += mesh_.cost[h];
      per_cost[i] = all[i].released.back() / cost, order[i] = i;
    }
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return per_cost[a] > per_cost[b]; });
    std::vector<char> is_near(mesh_.on_border.size(), 0);
    std::size_t taken = 0;
    for (std::size_t i = 0; i < order.size() && taken < k_most_new; ++i) {
      SlitFront& front = all[order[i]];
      if (std::any_of(front.way.begin(), front.way.end(), [&](Index h) { return is_near[mesh_.to(h)]; })) continue;
      for (const Index h : front.way) {
        is_near[mesh_.to(h)] = 1;
        for (const Index e : edges_.of(mesh_.to(h))) is_near[mesh_.to(e)] = 1;
      }
      fronts.push_back(std::move(front));
      ++taken;
    }
  }

 private:
  SlitFront of_tip(const SeamPath& path, bool at_end) const {
    const std::size_t count = std::min(k_behind, path.halfedges.size());
    double behind = 0, whole = 0;
    for (const Index h : path.halfedges) whole += mesh_.length(h);
    for (std::size_t i = 0; i < count; ++i)
      behind += mesh_.length(path.halfedges[at_end ? path.halfedges.size() - 1 - i : i]);
    const Index last = at_end ? path.halfedges.back() : path.halfedges.front();
    const Index base = path.halfedges[at_end ? path.halfedges.size() - count : count - 1];
    const Vec2 at = at_end ? state_.uv_at_end(last) : state_.uv(last);
    Vec2 left = at_end ? state_.uv(base) : state_.uv_at_end(base);
    Vec2 right = at_end ? state_.uv_at_end(mesh_.opposite[base]) : state_.uv(mesh_.opposite[base]);
    if (!at_end) std::swap(left, right);  // as seen along the slit towards its tip
    const Vec2 along = unit(at - 0.5 * (left + right)), gap = left - right;
    SlitFront front;
    if (!(behind > 0) || !(norm(along) > 0)) return front;
    const double release = 0.25 * std::numbers::pi * dot(gap, gap) / behind;
    const Vec2 direction = turned_to_hoop_tension(along, gap);
    Index v = at_end ? mesh_.to(last) : mesh_.from(last);
    for (double length = 0; release > 0 && length < k_most_growth * whole;) {
      const Index h = next_edge(edges_.of(v), direction, k_least_cosine);
      if (h == k_none) break;
      length += mesh_.length(h);
      front.way.push_back(h), front.released.push_back(release * length);
      v = mesh_.to(h);
    }
    return front;
  }

  static Vec2 turned_to_hoop_tension(Vec2 along, Vec2 gap) {
    const double k1 = std::max(0.0, dot(gap, left_of(along))), k2 = dot(gap, along);
    if (k2 == 0) return along;
    const double angle = 2 * std::atan((k1 - std::sqrt(k1 * k1 + 8 * k2 * k2)) / (4 * k2));
    return std::cos(angle) * along + std::sin(angle) * left_of(along);
  }

  /// Of half-edges from one vertex, that which runs most nearly in a direction of the map. @return k_none: none that
  /// leaves seams and borders alone does.
  Index next_edge(std::span<const Index> from, Vec2 direction, double least_cosine) const {
    Index best = k_none;
    for (const Index h : from) {
      const double cosine = dot(unit(state_.uv_at_end(h) - state_.uv(h)), direction);
      if (!state_.seam[h] && cosine > least_cosine && !is_blocked_[mesh_.to(h)]) least_cosine = cosine, best = h;
    }
    return best;
  }

  void find_strains() {
    strain_.resize(mesh_.rest.size());
    at_vertex_.resize(mesh_.on_border.size());
    for (Index t = 0; t < strain_.size(); ++t) {
      const Strain s = strain_[t] =
          strain_of(mesh_.rest[t], state_.uv(3 * t), state_.uv(3 * t + 1), state_.uv(3 * t + 2));
      const double area = mesh_.rest[t].area;
      for (const Index v : mesh_.mesh.triangles[t])
        at_vertex_[v].uu += area * s.uu, at_vertex_[v].uv += area * s.uv, at_vertex_[v].vv += area * s.vv;
    }
  }

  /// Half-edges within the chart from the start of a seam or border, in order around it. @return the half-edge on the
  /// other side of them, which ends there.
  Index around(Index h, std::vector<Index>& within) const {
    const auto before = [](Index e) { return e - e % 3 + (e % 3 + 2) % 3; };
    for (h = before(h); !state_.seam[h]; h = before(h)) {
      h = mesh_.opposite[h];
      within.push_back(h);
    }
    return h;
  }

  /// A slit from the start of a seam or border into the chart.
  SlitFront from_border(Index border) {
    within_.clear();
    const Index before = around(border, within_);
    SlitFront front;
    front.is_new = true;
    if (within_.empty() || mesh_.opposite[border] == before) return front;  // the latter: a tip
    const auto edge = [&](Index h) { return state_.uv_at_end(h) - state_.uv(h); };
    const auto stretched = [&](Index h) { return norm(edge(h)) / mesh_.length(h) - 1; };
    Vec2 direction = left_of(unit(unit(edge(border)) + unit(edge(before))));
    if (!(stretched(border) + stretched(before) > 0) || !(norm(direction) > 0)) return front;
    const double most = k_most_length * std::sqrt(mesh_.area);
    double opened = 0, length = 0, cost = 0, best = 0;
    std::size_t count = 0;
    while (length < most) {
      const Index h = next_edge(front.way.empty() ? within_ : edges_.of(mesh_.to(front.way.back())), direction,
                                k_least_cosine_of_new);
      if (h == k_none) break;
      const Vec2 across = left_of(unit(edge(h)));
      const double tension = 0.5 * (strain_[h / 3].along(across) + strain_[mesh_.opposite[h] / 3].along(across));
      if (!(tension > 0) || (length > 0 && !(tension * length > k_least_tension * opened))) break;
      opened += tension * mesh_.length(h), length += mesh_.length(h), cost += mesh_.cost[h];
      front.way.push_back(h);
      front.released.push_back(k_of_new * std::numbers::pi * opened * opened);
      if (front.released.back() > best * cost) best = front.released.back() / cost, count = front.way.size();
      const Vec2 next = at_vertex_[mesh_.to(h)].across_greatest();
      direction = unit(direction + (dot(next, direction) < 0 ? -1.0 : 1.0) * next);
    }
    front.way.resize(count), front.released.resize(count);
    return front;
  }

  const SeamMesh& mesh_;
  const OutgoingEdges& edges_;
  const SeamState& state_;
  std::vector<char> is_blocked_;  ///< Per vertex: on a seam or border.
  std::vector<SeamPath> paths_;
  std::vector<Strain> strain_, at_vertex_;  ///< Per triangle; summed by area.
  std::vector<Index> within_;
};

}  // namespace

std::vector<SlitFront> slit_fronts(const SeamMesh& mesh, const OutgoingEdges& edges, const SeamState& state) {
  FrontFinder finder(mesh, edges, state);
  std::vector<SlitFront> fronts;
  finder.add_tips(fronts);
  finder.add_new(fronts);
  return fronts;
}

}  // namespace papilla::param_detail
