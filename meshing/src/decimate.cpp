// SPDX-License-Identifier: MIT
#include "decimate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "check_mesh.hpp"
#include "mesh_attributes.hpp"
#include "papilla/core/bounds.hpp"

namespace papilla::detail {
namespace {

/// A triangle may turn by no more than this in one collapse.
constexpr double k_cos_turn = 0.2588;  // 75 degrees
/// Places of a higher degree, the hubs of fans, are looked at again only when their degree has halved or nothing else
/// is left to do: else a fan of n triangles would cost n^2.
constexpr Index k_hub_degree = 48;
/// At the end hubs are looked at so often; each time costs as much as their degrees.
constexpr int k_hub_rounds = 8;
/// Targets of a place that are checked, cheapest first; what all of them forbid the others mostly forbid, too.
constexpr int k_most_trials = 16;
/// The clock is looked at once for so many collapses.
constexpr std::size_t k_collapses_a_look = 1024;
/// The plane of a triangle with a smaller altitude, relative to the mesh's diagonal, is rounding noise.
constexpr double k_noise_altitude = 1e-6;

/// Sum of squared distances to planes, as a symmetric form around the place it belongs to when made.
struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  Vec3 b;
  double c = 0;

  /// The plane through p with unit normal n; coordinates relative to `origin`.
  void add_plane(const Vec3& n, const Vec3& p, const Vec3& origin) noexcept {
    const double d = dot(n, p - origin);
    xx += n.x * n.x, xy += n.x * n.y, xz += n.x * n.z, yy += n.y * n.y, yz += n.y * n.z, zz += n.z * n.z;
    b = b - d * n;
    c += d * d;
  }
  /// Adds `q`, whose origin lies at `shift` in this one's coordinates.
  void add(const Quadric& q, const Vec3& shift) noexcept {
    const Vec3 as = q.times(shift);
    b = b + q.b - as;
    c += q.c + dot(shift, as) - 2 * dot(q.b, shift);
    xx += q.xx, xy += q.xy, xz += q.xz, yy += q.yy, yz += q.yz, zz += q.zz;
  }
  Vec3 times(const Vec3& p) const noexcept {
    return {xx * p.x + xy * p.y + xz * p.z, xy * p.x + yy * p.y + yz * p.z, xz * p.x + yz * p.y + zz * p.z};
  }
  double operator()(const Vec3& p) const noexcept { return std::max(0.0, dot(p, times(p)) + 2 * dot(b, p) + c); }
};

/// A neighbour of a place and the triangles at their common edge.
struct Link {
  Index place = 0;
  Index count = 0;               ///< Triangles at the edge.
  std::array<Index, 2> from{};   ///< The first two triangles' wedges at the place ...
  std::array<Index, 2> to{};     ///< ... and at the neighbour.
  std::array<bool, 2> leaves{};  ///< Does the triangle run from the place to the neighbour?

  bool is_smooth() const noexcept {
    return count == 2 && from[0] == from[1] && to[0] == to[1] && leaves[0] != leaves[1];
  }
};

class Decimator {
 public:
  Decimator(const WedgeMesh& wedges, const std::vector<Index>& indices, const std::vector<std::uint8_t>& kept,
            const DecimateOptions& options)
      : wedges_(wedges),
        kept_(kept),
        options_(options),
        corners_(indices),
        next_(indices.size(), k_none),
        first_(wedges.positions.size(), k_none),
        last_(wedges.positions.size(), k_none),
        stamp_(wedges.positions.size(), 0),
        degree_(wedges.positions.size(), 0),
        degree_seen_(wedges.positions.size(), 0),
        is_postponed_(wedges.positions.size(), 0),
        mark_(wedges.positions.size()),
        quadrics_(wedges.positions.size()),
        alive_(indices.size() / 3) {
    for (Index c = 0; c < corners_.size(); ++c) {
      append(place_of(c), c, c);
      ++degree_[place_of(c)];
    }
    queue_.reserve(2 * wedges.positions.size() + 1);  // At most half of them hold, so that dropping the others pays.
    Bounds3 bounds;
    for (const Vec3& p : wedges.positions) bounds.add(p);
    noise_altitude_ = k_noise_altitude * bounds.diagonal();
  }

  std::vector<Index> run() {
    for (Index p = 0; p < first_.size(); ++p)
      if (first_[p] != k_none) start_quadric(p);
    for (Index p = 0; p < first_.size(); ++p)
      if (first_[p] != k_none) enqueue(p);
    for (int round = 0; round <= k_hub_rounds && alive_ > options_.target_triangles && !options_.deadline.passed();
         ++round) {
      take_candidates();
      std::vector<Index> hubs;
      hubs.swap(postponed_);
      for (const Index hub : hubs) {
        is_postponed_[hub] = 0;
        if (first_[hub] != k_none) enqueue(hub);
      }
      if (queue_.empty()) break;
    }
    std::vector<Index> result;
    result.reserve(3 * alive_);
    for (std::size_t t = 0; t < corners_.size(); t += 3)
      if (corners_[t] != k_none) result.insert(result.end(), &corners_[t], &corners_[t] + 3);
    return result;
  }

 private:
  struct Candidate {
    double order;
    Index from, to;
    std::uint32_t stamp;
    bool operator<(const Candidate& other) const noexcept {
      return order > other.order || (order >= other.order && from > other.from);
    }
  };

  struct Mark {
    std::uint32_t stamp = 0;
    Index link = 0;
  };

  void take_candidates() {
    for (std::size_t taken = 1; !queue_.empty() && alive_ > options_.target_triangles; ++taken) {
      if (taken % k_collapses_a_look == 0 && options_.deadline.passed()) return;
      std::pop_heap(queue_.begin(), queue_.end());
      const Candidate best = queue_.back();
      queue_.pop_back();
      if (stamp_[best.from] == best.stamp) collapse(best.from, best.to);
    }
  }

  Index place_of(Index corner) const noexcept { return wedges_.position_of_wedge[corners_[corner]]; }
  const Vec3& point(Index place) const noexcept { return wedges_.positions[place]; }
  static Index next_in_triangle(Index corner) noexcept { return corner % 3 == 2 ? corner - 2 : corner + 1; }
  static Index previous_in_triangle(Index corner) noexcept { return corner % 3 == 0 ? corner + 2 : corner - 1; }

  /// Adds the chain of corners from `begin` to `end` to a place.
  void append(Index place, Index begin, Index end) {
    if (first_[place] == k_none)
      first_[place] = begin;
    else
      next_[last_[place]] = begin;
    last_[place] = end;
  }

  /// The corners of remaining triangles at a place; removes the others from its list.
  void corners_at(Index place, std::vector<Index>& corners) {
    corners.clear();
    Index previous = k_none;
    for (Index c = first_[place]; c != k_none; c = next_[c]) {
      if (corners_[c] == k_none) continue;
      if (previous == k_none)
        first_[place] = c;
      else
        next_[previous] = c;
      previous = c;
      corners.push_back(c);
    }
    if (previous == k_none) {
      first_[place] = last_[place] = k_none;
      return;
    }
    next_[previous] = k_none;
    last_[place] = previous;
  }

  /// The neighbours of a place whose corners are given; link_to() finds them until the next call.
  void links_of(const std::vector<Index>& corners, std::vector<Link>& links) {
    links.clear();
    ++mark_now_;
    for (const Index c : corners) {
      add_link(links, c, next_in_triangle(c), true);
      add_link(links, c, previous_in_triangle(c), false);
    }
  }

  void add_link(std::vector<Link>& links, Index corner, Index other, bool leaves) {
    const Index place = place_of(other);
    Mark& mark = mark_[place];
    if (mark.stamp != mark_now_) {
      mark = {mark_now_, static_cast<Index>(links.size())};
      links.emplace_back();
      links.back().place = place;
    }
    Link& link = links[mark.link];
    if (link.count < 2) {
      link.from[link.count] = corners_[corner];
      link.to[link.count] = corners_[other];
      link.leaves[link.count] = leaves;
    }
    ++link.count;
  }

  const Link& link_to(Index place, const std::vector<Link>& links) const noexcept { return links[mark_[place].link]; }

  /// Unit normal, zero where it is noise.
  Vec3 reliable_normal(Index corner) const noexcept {
    const Vec3 &a = point(place_of(corner)), &b = point(place_of(next_in_triangle(corner))),
               &c = point(place_of(previous_in_triangle(corner)));
    const Vec3 n = cross(b - a, c - a);
    const double longest2 = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
    return dot(n, n) > noise_altitude_ * noise_altitude_ * longest2 ? normalized(n) : Vec3{};
  }

  void start_quadric(Index place) {
    corners_at(place, corners_here_);
    links_of(corners_here_, links_here_);
    Quadric& q = quadrics_[place];
    const Vec3& p = point(place);
    for (const Index c : corners_here_) {
      const Vec3 n = reliable_normal(c);
      q.add_plane(n, p, p);
      for (const Index other : {next_in_triangle(c), previous_in_triangle(c)}) {
        const Link& link = link_to(place_of(other), links_here_);
        if (!link.is_smooth()) q.add_plane(normalized(cross(point(link.place) - p, n)), p, p);
      }
    }
  }

  /// The places it may move to stand first in `links`; returns how many.
  std::size_t find_targets(Index place, std::vector<Link>& links) const {
    if (!kept_.empty() && kept_[place]) return 0;
    std::size_t creases = 0;
    for (std::size_t i = 0; i < links.size(); ++i) {
      if (links[i].count > 2) return 0;
      if (links[i].count == 1 && options_.lock_border) return 0;
      if (!links[i].is_smooth()) std::swap(links[i], links[creases++]);
    }
    if (creases == 0) return links.size();
    return creases == 2 ? 2 : 0;
  }

  /// Its surroundings changed: what was found for it no longer holds.
  void update(Index place) {
    ++stamp_[place];
    if (degree_[place] <= k_hub_degree || 2 * degree_[place] <= degree_seen_[place]) {
      enqueue(place);
    } else if (!is_postponed_[place]) {
      is_postponed_[place] = 1;
      postponed_.push_back(place);
    }
  }

  /// Finds the cheapest collapse that is allowed.
  void enqueue(Index place) {
    ++stamp_[place];
    degree_seen_[place] = degree_[place];
    corners_at(place, corners_here_);
    links_of(corners_here_, links_here_);
    const std::size_t targets = find_targets(place, links_here_);
    const double most = options_.error_mm * options_.error_mm;
    trials_.clear();
    for (std::size_t i = 0; i < targets; ++i) {
      const Vec3 d = point(links_here_[i].place) - point(place);
      const double error = quadrics_[place](d);
      if (error <= most) trials_.push_back({error + options_.length_weight * dot(d, d), static_cast<Index>(i)});
    }
    std::make_heap(trials_.begin(), trials_.end(), std::greater<>());
    for (int trial = 0; !trials_.empty() && trial < k_most_trials; ++trial) {
      std::pop_heap(trials_.begin(), trials_.end(), std::greater<>());
      const auto [order, link] = trials_.back();
      trials_.pop_back();
      if (!is_allowed(place, links_here_[link])) continue;
      if (queue_.size() == queue_.capacity()) drop_stale_candidates();
      queue_.push_back({order, place, links_here_[link].place, stamp_[place]});
      std::push_heap(queue_.begin(), queue_.end());
      return;
    }
  }

  /// A place has one candidate that holds, and leaves many behind that don't.
  void drop_stale_candidates() {
    std::erase_if(queue_, [&](const Candidate& c) { return stamp_[c.from] != c.stamp; });
    std::make_heap(queue_.begin(), queue_.end());
  }

  bool are_neighbours(Index place, Index other) {
    corners_at(place, corners_there_);
    return std::any_of(corners_there_.begin(), corners_there_.end(), [&](Index c) {
      return place_of(next_in_triangle(c)) == other || place_of(previous_in_triangle(c)) == other;
    });
  }

  /// How many neighbours the place of `links_here_` has in common with `target`.
  std::size_t count_common_neighbours(Index target) {
    std::size_t common = 0;
    if (degree_[target] > k_hub_degree) {  // looking at the few around the place is cheaper
      for (const Link& link : links_here_) common += link.place != target && are_neighbours(link.place, target);
      return common;
    }
    corners_at(target, corners_there_);
    ++mark_now_;
    for (const Index c : corners_there_) {
      mark_[place_of(next_in_triangle(c))].stamp = mark_now_;
      mark_[place_of(previous_in_triangle(c))].stamp = mark_now_;
    }
    for (const Link& link : links_here_) common += mark_[link.place].stamp == mark_now_;
    return common;
  }

  bool has_triangle(Index place, Index a, Index b) {
    corners_at(place, corners_there_);
    return std::any_of(corners_there_.begin(), corners_there_.end(), [&](Index c) {
      const Index next = place_of(next_in_triangle(c)), previous = place_of(previous_in_triangle(c));
      return (next == a && previous == b) || (next == b && previous == a);
    });
  }

  /// Keeps the topology, maps every wedge, turns no triangle too far. `corners_here_` and `links_here_` are the
  /// place's.
  bool is_allowed(Index place, const Link& target) {
    // Link condition: what is next to both is opposite the common edge. With three neighbours the edge between the
    // two others may be, too: a tetrahedron, or a fin on a surface, which would become a double sheet.
    if (count_common_neighbours(target.place) != target.count) return false;
    if (links_here_.size() == 3 && target.count == 2) {
      std::array<Index, 2> others{};
      std::size_t count = 0;
      for (const Link& link : links_here_)
        if (link.place != target.place) others[count++] = link.place;
      if (has_triangle(target.place, others[0], others[1])) return false;
    }

    const Vec3& to = point(target.place);
    for (const Index c : corners_here_) {
      const Index b = place_of(next_in_triangle(c)), a = place_of(previous_in_triangle(c));
      if (b == target.place || a == target.place) continue;
      if (target_wedge(target, corners_[c]) == k_none) return false;
      const Vec3 edge = point(a) - point(b);
      const Vec3 before = cross(edge, point(place) - point(b)), after = cross(edge, to - point(b));
      const double before2 = dot(before, before), after2 = dot(after, after);
      if (before2 > 0 && !(dot(before, after) > k_cos_turn * std::sqrt(before2 * after2))) return false;
    }
    return true;
  }

  static Index target_wedge(const Link& target, Index wedge) noexcept {
    const bool two = target.count == 2;
    if (target.from[0] == wedge)
      return two && target.from[1] == wedge && target.to[0] != target.to[1] ? k_none : target.to[0];
    return two && target.from[1] == wedge ? target.to[1] : k_none;
  }

  void collapse(Index from, Index to) {
    corners_at(from, corners_here_);
    links_of(corners_here_, links_here_);
    const Link target = link_to(to, links_here_);
    if (!is_allowed(from, target)) {  // what surrounds the target changed
      update(from);
      return;
    }
    for (const Index c : corners_here_) {
      const Index t = c - c % 3;
      if (place_of(next_in_triangle(c)) == to || place_of(previous_in_triangle(c)) == to) {
        for (Index k = t; k < t + 3; ++k) --degree_[place_of(k)];
        corners_[t] = corners_[t + 1] = corners_[t + 2] = k_none;
        --alive_;
      } else {
        corners_[c] = target_wedge(target, corners_[c]);
      }
    }
    degree_[to] += degree_[from];
    degree_[from] = 0;
    quadrics_[to].add(quadrics_[from], point(from) - point(to));
    append(to, first_[from], last_[from]);
    first_[from] = last_[from] = k_none;
    ++stamp_[from];

    ring_.clear();
    for (const Link& link : links_here_) ring_.push_back(link.place);
    for (const Index place : ring_) update(place);
  }

  const WedgeMesh& wedges_;
  const std::vector<std::uint8_t>& kept_;
  DecimateOptions options_;
  std::vector<Index> corners_;              ///< Wedge at each corner; k_none: the triangle is gone.
  std::vector<Index> next_, first_, last_;  ///< The corners at a place, as a chain.
  std::vector<std::uint32_t> stamp_;
  std::vector<Index> degree_, degree_seen_;  ///< Triangles at a place, now and when enqueue() last saw it.
  std::vector<Index> postponed_;
  std::vector<std::uint8_t> is_postponed_;
  std::vector<Mark> mark_;
  std::uint32_t mark_now_ = 0;
  std::vector<Quadric> quadrics_;  ///< Relative to their places.
  std::vector<Candidate> queue_;   ///< A heap: the cheapest collapse first.
  std::size_t alive_;
  double noise_altitude_ = 0;
  std::vector<Index> corners_here_, corners_there_, ring_;
  std::vector<Link> links_here_;
  std::vector<std::pair<double, Index>> trials_;
};

}  // namespace

std::vector<Index> decimate(const WedgeMesh& wedges, const std::vector<Index>& indices,
                            const std::vector<std::uint8_t>& kept, const DecimateOptions& options) {
  return Decimator(wedges, indices, kept, options).run();
}

}  // namespace papilla::detail
