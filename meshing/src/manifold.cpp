// SPDX-License-Identifier: MIT
#include "papilla/meshing/manifold.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>

#include "check_mesh.hpp"
#include "edge_table.hpp"
#include "papilla/core/error.hpp"
#include "point_tree.hpp"
#include "union_find.hpp"

namespace papilla {
namespace {

using namespace detail;

/// Copies move by at most this fraction of the shortest edge around, so that no triangle turns over.
constexpr double k_largest_move = 0.2;

/// Copies keep this fraction of the gap from every other vertex: twice the weld's tolerance at the default gap.
constexpr double k_clearance = 0.6;

bool is_bad(std::span<const Index> halfedges, const std::vector<Triangle>& triangles) {
  return halfedges.size() > 2 ||
         (halfedges.size() == 2 && runs_up(triangles, halfedges[0]) == runs_up(triangles, halfedges[1]));
}

/// The half-edges of one edge in the order of their triangles around it, counter-clockwise seen against the edge's
/// direction from its smaller to its larger vertex.
std::vector<Index> sorted_around(const TriangleMesh& mesh, std::span<const Index> halfedges) {
  const Index h0 = halfedges.front();
  Index low = from_vertex(mesh.triangles, h0), high = to_vertex(mesh.triangles, h0);
  if (low > high) std::swap(low, high);
  const Vec3 origin = mesh.positions[low], axis = normalized(mesh.positions[high] - origin);
  const auto apex = [&](Index h) {
    const Vec3 w = mesh.positions[from_vertex(mesh.triangles, previous_halfedge(h))] - origin;
    return w - dot(w, axis) * axis;
  };
  const Vec3 x = normalized(apex(h0)), y = cross(axis, x);
  std::vector<std::tuple<double, bool, Index>> sorted;
  for (const Index h : halfedges) {
    const Vec3 w = apex(h);
    // Downward first at equal angles: an opposite pair that lies in one place encloses nothing.
    sorted.emplace_back(std::atan2(dot(w, y), dot(w, x)), runs_up(mesh.triangles, h), h);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<Index> order;
  for (const auto& entry : sorted) order.push_back(std::get<2>(entry));
  return order;
}

/// Pairs half-edges of one edge like brackets around it: the inner side of a downward one lies at growing angles, that
/// of an upward one at falling angles, so a downward one and the next upward one after it bound one solid.
void pair_around(const TriangleMesh& mesh, std::span<const Index> halfedges, std::vector<Index>& opposite) {
  const std::vector<Index> order = sorted_around(mesh, halfedges);
  std::vector<Index> open;
  for (int round = 0; round < 2; ++round)  // the second round closes brackets over the start of the circle
    for (const Index h : order) {
      if (opposite[h] != k_none) continue;
      if (!runs_up(mesh.triangles, h)) {
        if (round == 0) open.push_back(h);
      } else if (!open.empty()) {
        opposite[h] = open.back();
        opposite[open.back()] = h;
        open.pop_back();
      }
    }
}

/// Finds places for copies that keep clear of all vertices and of each other, so that no weld joins them again.
class FreePlaces {
 public:
  FreePlaces(const std::vector<Vec3>& positions, double clearance)
      : clearance_(clearance), tree_(positions, all_of(positions)) {}

  /// start + m · step for the smallest m from 1 that is clear; m = 16 when none is.
  Vec3 along(const Vec3& start, const Vec3& step) {
    constexpr int k_tries = 16;
    Vec3 place = start + step;
    for (int m = 1; m < k_tries && !is_clear(place); ++m) place = place + step;
    placed_.emplace(cell_of(place, 0, 0, 0), place);
    return place;
  }

 private:
  using Cell = std::array<double, 3>;  // whole numbers, whatever their size

  static std::vector<Index> all_of(const std::vector<Vec3>& positions) {
    std::vector<Index> all(positions.size());
    std::iota(all.begin(), all.end(), Index{0});
    return all;
  }

  Cell cell_of(const Vec3& p, int dx, int dy, int dz) const {
    const auto index = [this](double value, int d) { return std::floor(value / clearance_) + d; };
    return {index(p.x, dx), index(p.y, dy), index(p.z, dz)};
  }

  bool is_clear(const Vec3& p) const {
    bool clear = true;
    tree_.near_point(p, clearance_, [&](Index, const Vec3& q) { clear = clear && norm(q - p) >= clearance_; });
    for (int i = 0; i < 27 && clear; ++i) {
      const auto [begin, end] = placed_.equal_range(cell_of(p, i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
      for (auto other = begin; other != end && clear; ++other) clear = norm(other->second - p) >= clearance_;
    }
    return clear;
  }

  double clearance_;
  PointTree tree_;
  std::multimap<Cell, Vec3> placed_;
};

class Splitter {
 public:
  Splitter(TriangleMesh& mesh, double gap, ManifoldResult& result)
      : mesh_(mesh),
        gap_(gap),
        result_(result),
        edges_(mesh.triangles, mesh.positions.size()),
        opposite_(opposite_halfedges(mesh.triangles, edges_)) {}

  void run() {
    find_bad_edges();
    copy_vertices();
    if (!bad_edges_.empty()) part_edges_between_same_vertices();
  }

 private:
  struct Copy {
    Index vertex, fan, corner;
    auto operator<=>(const Copy&) const = default;
  };

  /// Where a vertex goes that is parted from another one at `start`.
  Vec3 place(const Vec3& start, const Vec3& step) {
    if (!(gap_ > 0)) return start;
    if (!places_) places_.emplace(mesh_.positions, k_clearance * gap_);
    const Vec3 free = places_->along(start, step);
    result_.max_deviation_mm = std::max(result_.max_deviation_mm, norm(free - start));
    return free;
  }

  void find_bad_edges() {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const auto h = edges_.halfedges(e);
      if (!is_bad(h, mesh_.triangles)) continue;
      bad_edges_.push_back(e);
      if (h.size() > 2) pair_around(mesh_, h, opposite_);
    }
    result_.parted_edges = bad_edges_.size();
  }

  /// Gives every fan of a vertex but the first its own copy of the vertex.
  void copy_vertices() {
    UnionFind fans = join_fans(opposite_);
    std::vector<Index> first_fan(mesh_.positions.size(), k_none);
    std::vector<Copy> copies;
    for (Index corner = 0; corner < fans.size(); ++corner) {
      const Index v = from_vertex(mesh_.triangles, corner), fan = fans.find(corner);
      if (first_fan[v] == k_none) first_fan[v] = fan;
      if (first_fan[v] != fan) copies.push_back({v, fan, corner});
    }
    if (copies.empty()) return;
    std::sort(copies.begin(), copies.end());
    const std::vector<std::uint8_t> at_bad_edge = corners_at_bad_edges(fans);
    const std::vector<double> shortest = shortest_edges(copies);

    std::vector<std::pair<Index, Index>> new_corners;  // corner, vertex
    std::vector<std::pair<Index, Vec3>> moves;
    for (std::size_t begin = 0, end = 0; begin < copies.size(); begin = end) {
      const auto [v, fan, corner] = copies[begin];
      const Index copy = static_cast<Index>(mesh_.positions.size());
      mesh_.positions.push_back(Vec3{mesh_.positions[v]});
      ++result_.added_vertices;
      Vec3 inward{};
      for (; end < copies.size() && copies[end].fan == fan && copies[end].vertex == v; ++end) {
        new_corners.emplace_back(copies[end].corner, copy);
        inward = inward + towards_opposite_side(copies[end].corner);
      }
      if (!at_bad_edge[fan]) continue;
      const double step = std::min(gap_, k_largest_move * shortest[v]);
      moves.emplace_back(copy, step * normalized(inward));
    }
    for (const auto& [corner, vertex] : new_corners) mesh_.triangles[triangle_of(corner)][corner_of(corner)] = vertex;
    for (const auto& [vertex, step] : moves) mesh_.positions[vertex] = place(mesh_.positions[vertex], step);
  }

  /// Per fan (its first corner): does it touch a bad edge at its vertex?
  std::vector<std::uint8_t> corners_at_bad_edges(UnionFind& fans) const {
    std::vector<std::uint8_t> flag(fans.size(), 0);
    for (const std::size_t e : bad_edges_)
      for (const Index h : edges_.halfedges(e)) flag[fans.find(h)] = flag[fans.find(next_halfedge(h))] = 1;
    return flag;
  }

  /// The shortest edge around each vertex that gets copies.
  std::vector<double> shortest_edges(const std::vector<Copy>& copies) const {
    std::vector<double> shortest(mesh_.positions.size(), -1);
    for (const Copy& copy : copies) shortest[copy.vertex] = std::numeric_limits<double>::max();
    for (const Triangle& t : mesh_.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const Index a = t[k], b = t[next_corner(k)];
        if (shortest[a] < 0 && shortest[b] < 0) continue;
        const double length = norm(mesh_.positions[b] - mesh_.positions[a]);
        shortest[a] = std::min(shortest[a], length);
        shortest[b] = std::min(shortest[b], length);
      }
    return shortest;
  }

  Vec3 towards_opposite_side(Index corner) const {
    const Index p = from_vertex(mesh_.triangles, next_halfedge(corner));
    const Index q = from_vertex(mesh_.triangles, previous_halfedge(corner));
    const Vec3 v = mesh_.positions[from_vertex(mesh_.triangles, corner)];
    return normalized(0.5 * (mesh_.positions[p] + mesh_.positions[q]) - v);
  }

  /// Sheets whose parted edges still run between the same two vertices, because their fans are one at both ends,
  /// get a vertex in the middle of all but the first.
  void part_edges_between_same_vertices() {
    std::vector<std::uint8_t> changed(mesh_.triangles.size(), 0);
    for (const std::size_t e : bad_edges_) {
      std::map<std::pair<Index, Index>, std::size_t> uses;
      for (const Index h : edges_.halfedges(e)) {
        const Index other = opposite_[h];
        if (other != k_none && other < h) continue;
        if (changed[triangle_of(h)] || (other != k_none && changed[triangle_of(other)])) continue;
        const std::pair<Index, Index> ends =
            std::minmax({from_vertex(mesh_.triangles, h), to_vertex(mesh_.triangles, h)});
        if (uses[ends]++ == 0) continue;
        split_in_the_middle(h);
        changed[triangle_of(h)] = 1;
        if (other != k_none) changed[triangle_of(other)] = 1;
      }
    }
  }

  void split_in_the_middle(Index h) {
    const Vec3 a = mesh_.positions[from_vertex(mesh_.triangles, h)], b = mesh_.positions[to_vertex(mesh_.triangles, h)];
    const Vec3 middle = 0.5 * (a + b);
    const auto apex = [&](Index halfedge) {
      return mesh_.positions[from_vertex(mesh_.triangles, previous_halfedge(halfedge))];
    };
    Vec3 inward = normalized(apex(h) - middle);
    if (opposite_[h] != k_none) inward = inward + normalized(apex(opposite_[h]) - middle);
    const Index vertex = static_cast<Index>(mesh_.positions.size());
    mesh_.positions.push_back(place(middle, std::min(gap_, k_largest_move * norm(b - a)) * normalized(inward)));
    ++result_.split_edges;
    split_triangle(mesh_, triangle_of(h), corner_of(h), vertex, 0.5);
    if (opposite_[h] != k_none) split_triangle(mesh_, triangle_of(opposite_[h]), corner_of(opposite_[h]), vertex, 0.5);
  }

  TriangleMesh& mesh_;
  double gap_;
  ManifoldResult& result_;
  EdgeTable edges_;
  std::vector<Index> opposite_;
  std::vector<std::size_t> bad_edges_;
  std::optional<FreePlaces> places_;
};

}  // namespace

ManifoldResult split_nonmanifold(TriangleMesh mesh, const ManifoldOptions& options) {
  if (!(options.relative_gap >= 0 && options.relative_gap <= 0.01))
    throw InvalidInput("split_nonmanifold: relative_gap " + std::to_string(options.relative_gap) +
                       " is not in [0, 0.01]");
  check_mesh(mesh, "split_nonmanifold");
  ManifoldResult result;
  const double gap = options.relative_gap * bounding_diagonal(mesh);
  Splitter(mesh, gap, result).run();
  result.mesh = std::move(mesh);
  return result;
}

}  // namespace papilla
