// SPDX-License-Identifier: MIT
#include "disk_hierarchy.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>

namespace papilla::param_detail {
namespace {

constexpr Index k_none = ~Index{0};

/// Vertices with more triangles stay until their neighbours are gone.
constexpr std::size_t k_most_triangles = 24;

/// Rings of at most so many triangles are kept from when they are judged until the vertex goes.
constexpr std::size_t k_most_kept = 8;

/// Triangles of a target that are looked through at most.
constexpr std::size_t k_most_of_target = 200;

/// Vertices that one thread judges at a time.
constexpr std::size_t k_together = 256;

/// In one pass, only the cheapest part of the vertices is removed.
constexpr double k_pass_share = 0.8;

/// What the three rounds ask of new triangles: the least cosine of their normal with the old ones', and the least shape
/// (4√3 area / sum of squared edges), unless they are half as good as the old ones. A map of the coarse mesh can be no
/// better than its triangles; the last round serves topology alone.
struct Round {
  double cosine, shape;
  std::size_t enough;
};
constexpr std::array<Round, 3> k_rounds{{{0.3, 0.1, 0}, {-0.5, 0.03, 0}, {-2.0, 0, 400}}};

/// A pass that removes less than this part of the vertices lowers what is asked of the shape.
constexpr double k_poor_pass = 0.02;

}  // namespace

class DiskHierarchy::Coarsener {
 public:
  Coarsener(DiskHierarchy& result, std::span<const Vec3> positions)
      : h_(result),
        positions_(positions),
        head_(positions.size(), k_none),
        tail_(positions.size(), k_none),
        next_(3 * h_.triangles_.size(), k_none),
        locked_(positions.size(), 0),
        kept_(std::make_unique_for_overwrite<KeptRing[]>(positions.size())) {
    h_.removals_.reserve(positions.size());
    h_.around_.reserve(next_.size());
    for (Index c = 0; c < next_.size(); ++c) {
      const Index v = h_.triangles_[c / 3][c % 3];
      if (head_[v] == k_none)
        head_[v] = c;
      else
        next_[tail_[v]] = c;
      tail_[v] = c;
    }
    for (Index v = 0; v < head_.size(); ++v) {
      kept_[v].triangles = 0;
      if (head_[v] != k_none) vertices_.push_back(v);
    }
  }

  void run(std::size_t enough) {
    for (const Round& round : k_rounds)
      while (vertices_.size() > std::max(enough, round.enough)) {
        const std::size_t before = vertices_.size();
        pass(round, std::max(enough, round.enough));
        const double removed = static_cast<double>(before - vertices_.size());
        if (removed < std::max(1.0, k_poor_pass * static_cast<double>(before))) break;
      }
    h_.vertex_count_ = vertices_.size();
  }

 private:
  /// What surrounds a vertex, counter-clockwise; the border vertices first and last when it lies on the border.
  struct Ring {
    std::array<Index, k_most_triangles + 1> vertex;
    std::array<Index, k_most_triangles> corner;       ///< At the vertex, of the triangles.
    std::array<Vec3, k_most_triangles + 1> position;  ///< Of the vertices; set by best_target().
    std::size_t triangles = 0, size = 0;
    bool closed = false;
    Vec3 normal;  ///< Sum of the triangles' cross products; set by best_target().
    std::size_t after(std::size_t i) const { return i + 1 == size ? 0 : i + 1; }
  };

  /// The corners of a short one; none: it is to be found again. Those of removed triangles may be among them.
  struct KeptRing {
    std::array<Index, k_most_kept> corner;
    std::uint8_t triangles;
    bool closed;
  };

  struct Candidate {
    double cost;
    Index vertex, target;
    bool operator<(const Candidate& other) const {
      return cost != other.cost ? cost < other.cost : vertex < other.vertex;
    }
  };

  void pass(const Round& round, std::size_t enough) {
    for_all([&](Index, Index v) {
      if (locked_[v] == pass_) drop_dead(v);
    });
    std::vector<Candidate> candidates(vertices_.size());
    for_all([&](Index i, Index v) {
      Ring ring;
      const bool found = ring_of(v, ring);
      keep(v, ring, found);
      candidates[i] = found ? best_target(v, ring, round) : Candidate{0, v, k_none};
    });
    std::erase_if(candidates, [](const Candidate& c) { return c.target == k_none; });
    const auto used = candidates.begin() +
                      static_cast<std::ptrdiff_t>(std::ceil(k_pass_share * static_cast<double>(candidates.size())));
    std::nth_element(candidates.begin(), used, candidates.end());
    oneapi::tbb::parallel_sort(candidates.begin(), used);
    ++pass_;
    h_.passes_.push_back(h_.removals_.size());
    Ring ring;
    std::size_t left = vertices_.size();
    for (auto c = candidates.begin(); c != used && left > enough; ++c) {
      // An unlocked vertex still has the ring it was judged by; the neighbours of a target that is locked have changed.
      if (locked_[c->vertex] == pass_) continue;
      ring_of(c->vertex, ring);
      if (locked_[c->target] == pass_ && !may_merge(ring, place_of(ring, c->target))) continue;
      remove(c->vertex, c->target, ring);
      --left;
    }
    std::erase_if(vertices_, [&](Index v) { return head_[v] == k_none; });
  }

  static std::size_t place_of(const Ring& ring, Index vertex) {
    return static_cast<std::size_t>(std::find(ring.vertex.begin(), ring.vertex.begin() + ring.size, vertex) -
                                    ring.vertex.begin());
  }

  /// Calls visit(place, vertex) for all that are left, in parallel.
  template <class Visit>
  void for_all(const Visit& visit) const {
    oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, vertices_.size(), k_together),
                              [&](const auto& range) {
                                for (std::size_t i = range.begin(); i < range.end(); ++i)
                                  visit(static_cast<Index>(i), vertices_[i]);
                              });
  }

  /// Takes corners of removed triangles out of the vertex's list.
  void drop_dead(Index v) {
    Index* link = &head_[v];
    tail_[v] = k_none;
    while (*link != k_none) {
      const Index c = *link;
      if (h_.alive_[c / 3])
        tail_[v] = c, link = &next_[c];
      else
        *link = next_[c];
    }
  }

  template <class Visit>
  void each_corner(Index v, Visit visit) const {
    for (Index c = head_[v]; c != k_none; c = next_[c])
      if (h_.alive_[c / 3] && !visit(c)) return;
  }

  bool find_ring(Index v, Ring& ring) const {
    std::array<Index, k_most_triangles> from, to, corner;
    std::size_t count = 0;
    bool small = true;
    each_corner(v, [&](Index c) {
      if (count == k_most_triangles) return small = false;
      from[count] = after(c, 1);
      to[count] = after(c, 2);
      corner[count++] = c;
      return true;
    });
    if (!small || count == 0) return false;
    // Sorts the triangles around the vertex: ahead from the first one, then behind it.
    std::size_t ordered = 1;
    const auto append_next = [&](const std::array<Index, k_most_triangles>& list, Index wanted) {
      for (std::size_t i = ordered; i < count; ++i)
        if (list[i] == wanted) {
          std::swap(from[i], from[ordered]), std::swap(to[i], to[ordered]), std::swap(corner[i], corner[ordered]);
          ++ordered;
          return true;
        }
      return false;
    };
    while (append_next(from, to[ordered - 1])) {
    }
    const std::size_t ahead = ordered;
    ring.closed = to[ahead - 1] == from[0];
    if (!ring.closed)
      while (append_next(to, from[ordered == ahead ? 0 : ordered - 1])) {
      }
    if (ordered != count) return false;
    ring.triangles = ring.size = count;
    const std::size_t behind = count - ahead;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = ring.closed ? (i + 1) % count : i < behind ? count - 1 - i : i - behind;
      ring.vertex[i] = from[at];
      ring.corner[i] = corner[at];
    }
    if (!ring.closed) ring.vertex[ring.size++] = to[ahead - 1];
    return is_ring(ring);
  }

  void keep(Index v, const Ring& ring, bool found) {
    KeptRing& kept = kept_[v];
    kept.triangles = 0;
    if (!found || ring.triangles > k_most_kept) return;
    std::copy_n(ring.corner.begin(), ring.triangles, kept.corner.begin());
    kept.triangles = static_cast<std::uint8_t>(ring.triangles);
    kept.closed = ring.closed;
  }

  /// The kept ring without what was removed: others keep their order, unless the vertex was a target.
  bool ring_of(Index v, Ring& ring) const {
    const KeptRing& kept = kept_[v];
    if (kept.triangles == 0) return find_ring(v, ring);
    std::size_t count = 0;
    for (std::size_t i = 0; i < kept.triangles; ++i)
      if (h_.alive_[kept.corner[i] / 3]) ring.corner[count++] = kept.corner[i];
    ring.triangles = ring.size = count;
    ring.closed = kept.closed;
    const auto begin = ring.corner.begin(), end = begin + static_cast<std::ptrdiff_t>(count);
    if (ring.closed && count > 0 && ring.corner[count - 1] != head_[v])
      std::rotate(begin, std::find(begin, end, head_[v]) + 1, end);  // as find_ring() begins
    for (std::size_t i = 0; i < count; ++i) ring.vertex[i] = after(ring.corner[i], 1);
    if (!ring.closed && count > 0) ring.vertex[ring.size++] = after(ring.corner[count - 1], 2);
    return is_ring(ring);
  }

  static bool is_ring(const Ring& ring) { return ring.closed ? ring.size >= 3 : ring.triangles >= 2; }

  /// The vertex that comes so many corners later in the corner's triangle.
  Index after(Index corner, Index places) const { return h_.triangles_[corner / 3][(corner % 3 + places) % 3]; }

  /// The vertex may slide onto ring vertex `place`: the target has no edge yet to those it will be linked with.
  bool may_merge(const Ring& ring, std::size_t place) const {
    std::array<Index, k_most_triangles + 1> linked;  // Will be, and must not be yet.
    std::size_t links = 0;
    for (std::size_t i = 0; i < ring.size; ++i) {
      const std::size_t apart = i > place ? i - place : place - i;
      if (apart > 1 && !(ring.closed && apart == ring.size - 1)) linked[links++] = ring.vertex[i];
    }
    const auto is_linked = [&](Index v) {
      return std::find(linked.begin(), linked.begin() + links, v) != linked.begin() + links;
    };
    std::size_t count = 0;
    bool may = true;
    each_corner(ring.vertex[place], [&](Index c) {
      return may = ++count <= k_most_of_target && !is_linked(after(c, 1)) && !is_linked(after(c, 2));
    });
    return may;
  }

  Candidate best_target(Index v, Ring& ring, const Round& round) const {
    const Vec3 origin = positions_[v];
    for (std::size_t i = 0; i < ring.size; ++i) ring.position[i] = positions_[ring.vertex[i]];
    ring.normal = {};
    for (std::size_t i = 0; i < ring.triangles; ++i)
      ring.normal = ring.normal + cross(ring.position[i] - origin, ring.position[ring.after(i)] - origin);
    Candidate best{std::numeric_limits<double>::infinity(), v, k_none};
    if (!ring.closed) {
      consider(v, ring, 0, round, best);
      consider(v, ring, ring.size - 1, round, best);
      return best;
    }
    std::array<double, k_most_triangles> squared;
    for (std::size_t i = 0; i < ring.size; ++i) {
      const Vec3 e = ring.position[i] - origin;
      squared[i] = dot(e, e);
    }
    const auto shortest =
        static_cast<std::size_t>(std::min_element(squared.begin(), squared.begin() + ring.size) - squared.begin());
    consider(v, ring, shortest, round, best);
    for (std::size_t i = 0; i < ring.size && best.target == k_none; ++i)
      if (i != shortest) consider(v, ring, i, round, best);
    return best;
  }

  /// 1 for an equilateral triangle, 0 for one without area.
  static double shape(double doubled_area, double squares) {
    return squares > 0 ? 2 * std::sqrt(3.0) * doubled_area / squares : 0;
  }

  static double worst_shape(Vec3 origin, const Ring& ring) {
    double worst = 1;
    for (std::size_t i = 0; i < ring.triangles; ++i) {
      const Vec3 p = ring.position[i] - origin, q = ring.position[ring.after(i)] - origin;
      const Vec3 r = q - p;
      worst = std::min(worst, shape(norm(cross(p, q)), dot(p, p) + dot(q, q) + dot(r, r)));
    }
    return worst;
  }

  void consider(Index v, const Ring& ring, std::size_t place, const Round& round, Candidate& best) const {
    const Vec3 origin = positions_[v], target = ring.position[place];
    const Vec3 edge = target - origin, normal = ring.normal;
    const double size = norm(normal);
    double cosine = 1, quality = 1;
    for (std::size_t i = 0; i < ring.triangles; ++i) {
      const std::size_t j = ring.after(i);
      if (i == place || j == place) continue;
      const Vec3 p = ring.position[i] - target, q = ring.position[j] - target, r = q - p;
      const Vec3 doubled = cross(p, q);
      const double area = norm(doubled);
      if (area > 0 && size > 0) cosine = std::min(cosine, dot(doubled, normal) / (area * size));
      quality = std::min(quality, shape(area, dot(p, p) + dot(q, q) + dot(r, r)));
    }
    if (cosine < round.cosine) return;
    if (quality < round.shape && quality < 0.5 * worst_shape(origin, ring)) return;
    if (!ring.closed) {
      const Vec3 in = origin - ring.position.front(), out = ring.position[ring.size - 1] - origin;
      const double lengths = norm(in) * norm(out);
      if (lengths > 0) cosine = std::min(cosine, dot(in, out) / lengths);
    }
    const double cost = dot(edge, edge) * (0.05 + 1 - cosine) / std::max(quality, 0.05);
    if (cost < best.cost && may_merge(ring, place)) best.cost = cost, best.target = ring.vertex[place];
  }

  void remove(Index v, Index target, const Ring& ring) {
    Removal removal{v, target, static_cast<Index>(h_.around_.size()), static_cast<Index>(ring.triangles)};
    for (std::size_t i = 0; i < ring.triangles; ++i) {
      const Index t = ring.corner[i] / 3;
      h_.around_.push_back(t);
      Triangle& corners = h_.triangles_[t];
      if (std::find(corners.begin(), corners.end(), target) != corners.end())
        h_.alive_[t] = 0;
      else
        std::replace(corners.begin(), corners.end(), v, target);
    }
    for (std::size_t i = 0; i < ring.size; ++i) locked_[ring.vertex[i]] = pass_;
    locked_[v] = pass_;
    // The next pass drops what vanished.
    next_[tail_[target]] = head_[v];
    tail_[target] = tail_[v];
    head_[v] = tail_[v] = k_none;
    kept_[target].triangles = 0;
    h_.removals_.push_back(removal);
  }

  DiskHierarchy& h_;
  std::span<const Vec3> positions_;
  std::vector<Index> head_, tail_, next_;  ///< Corners of each vertex as a list.
  std::vector<std::uint32_t> locked_;      ///< The last pass that changed the vertex's triangles.
  std::unique_ptr<KeptRing[]> kept_;       ///< Of each vertex.
  std::uint32_t pass_ = 0;
  std::vector<Index> vertices_;
};

DiskHierarchy::DiskHierarchy(std::span<const Vec3> positions, std::span<const Triangle> triangles, std::size_t enough)
    : triangles_(triangles.begin(), triangles.end()), alive_(triangles.size(), 1) {
  Coarsener(*this, positions).run(enough);
  removed_ = removals_.size();
}

std::size_t DiskHierarchy::apart() const {
  return removed_ - *std::prev(std::lower_bound(passes_.begin(), passes_.end(), removed_));
}

std::span<const Removal> DiskHierarchy::restore(std::size_t count) {
  removed_ -= count;
  vertex_count_ += count;
  const std::span<const Removal> undone(removals_.data() + removed_, count);
  oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, count, k_together), [&](const auto& range) {
    for (const Removal& removal : undone.subspan(range.begin(), range.size()))
      for (const Index t : around(removal)) {
        if (alive_[t]) std::replace(triangles_[t].begin(), triangles_[t].end(), removal.target, removal.vertex);
        alive_[t] = 1;
      }
  });
  return undone;
}

void DiskHierarchy::remove_again() {
  const Removal removal = removals_[removed_++];
  for (const Index t : around(removal)) {
    Triangle& corners = triangles_[t];
    if (std::find(corners.begin(), corners.end(), removal.target) != corners.end())
      alive_[t] = 0;
    else
      std::replace(corners.begin(), corners.end(), removal.vertex, removal.target);
  }
  --vertex_count_;
}

}  // namespace papilla::param_detail
