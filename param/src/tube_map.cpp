// SPDX-License-Identifier: MIT
#include "tube_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "corners_of_vertices.hpp"
#include "disk_borders.hpp"
#include "sparse_cholesky.hpp"

namespace papilla::param_detail {
namespace {

constexpr double k_turn = 2 * std::numbers::pi;

/// Cotangents count as no less, so that the map of the wall is injective, and as no more.
constexpr double k_least_cotangent = 0.05;
constexpr double k_most_cotangent = 50;

/// Angles around the pole count as no less than this fraction of their mean.
constexpr double k_least_angle = 0.3;

/// How much more than they have to, rings are apart.
constexpr double k_sag_margin = 1.5;

/// An end counts when it is this part of the depth deeper than where it leaves the rest.
constexpr double k_second_end = 0.1;

/// Rings whose scales are free, about, and how few vertices lie between the first ones and between the last ones.
constexpr std::size_t k_rings = 24;
constexpr std::size_t k_least_between = 8;

/// The disk without its deepest vertex, the pole, cut along the shortest way from the border to the pole's ring.
struct Wall {
  Index pole = 0, foot = 0;  ///< The cut begins at the foot, on the border.
  std::vector<Index> ring;   ///< Around the pole, counter-clockwise from the cut on; empty when it is not free.
  std::vector<double> turn;  ///< Per corner of a triangle: a full turn on the left of the cut, else 0.

  explicit Wall(const FilledDisk& disk) : turn(3 * disk.triangles.size(), 0) {
    const BorderDistance distance = border_distance(disk);
    const CornersOfVertices corners(disk.triangles, disk.where.size());
    pole = static_cast<Index>(std::max_element(distance.depth.begin(), distance.depth.end()) - distance.depth.begin());
    std::vector<char> on_border(disk.where.size(), 0), on_ring(disk.where.size(), 0);
    for (const Index v : disk.border) on_border[v] = 1;
    const std::size_t count = corners.of(pole).size();
    std::vector<Index> way{pole};
    for (Index v = distance.before[pole];; v = distance.before[v]) {
      for (const Index c : corners.of(v)) on_ring[v] |= next(disk, c) == pole;
      if (on_ring[v]) way.resize(1);
      way.push_back(v);
      if (distance.before[v] == v) break;
    }
    bool free = on_ring[way[1]] && count >= 3;
    for (Index v = way[1]; free;) {
      ring.push_back(v);
      free = !on_border[v] && ring.size() <= count;
      Index after = pole;
      for (const Index c : corners.of(pole))
        if (next(disk, c) == v) after = next(disk, following(c));
      v = after;
      if (v == way[1]) break;
    }
    if (!free || ring.size() != count) {
      ring.clear();
      return;
    }
    foot = way.back();
    for (std::size_t i = 1; i < way.size(); ++i)
      turn_left(disk, corners, way[i], way[i - 1], i + 1 < way.size() ? way[i + 1] : way[i]);
  }

 private:
  static Index following(Index corner) { return corner - corner % 3 + (corner + 1) % 3; }
  static Index next(const FilledDisk& disk, Index corner) { return disk.triangles[corner / 3][following(corner) % 3]; }

  /// The corners at v counter-clockwise from the edge to `in` to the edge to `out`, or to the border.
  void turn_left(const FilledDisk& disk, const CornersOfVertices& corners, Index v, Index in, Index out) {
    for (Index w = in; w != out;) {
      const auto around = corners.of(v);
      const auto c = std::find_if(around.begin(), around.end(), [&](Index corner) { return next(disk, corner) == w; });
      if (c == around.end()) return;
      turn[*c] = k_turn;
      const Index t = *c / 3, k = *c % 3;
      w = disk.triangles[t][(k + 2) % 3];
    }
  }
};

double cotangent(Vec3 apex, Vec3 a, Vec3 b) {
  const Vec3 p = a - apex, q = b - apex;
  const double size = norm(cross(p, q));
  return size > 0 ? std::clamp(dot(p, q) / size, k_least_cotangent, k_most_cotangent) : 1;
}

/// Where vertices are on the cylinder: turn, and height between 0 at the ring and 1 at the border.
struct Cylinder {
  std::vector<double> turn, height;
};

class WallMap {
 public:
  WallMap(const FilledDisk& disk, const Wall& wall)
      : disk_(disk), wall_(wall), row_(disk.where.size(), k_none), at_{std::vector<double>(disk.where.size(), 0), {}} {
    at_.height.resize(disk.where.size(), 0);
    std::vector<char> fixed(disk.where.size(), 0);
    fixed[wall.pole] = 1;
    fix_border(fixed);
    fix_ring(fixed);
    for (Index v = 0; v < row_.size(); ++v)
      if (!fixed[v]) row_[v] = static_cast<Index>(where_free_.size()), where_free_.push_back(disk.where[v]);
  }

  Cylinder run() {
    if (!where_free_.empty()) solve();
    untwist();
    return std::move(at_);
  }

 private:
  static constexpr Index k_none = ~Index{0};

  void fix_border(std::vector<char>& fixed) {
    // Angles count from the cut.
    std::size_t start = 0;
    for (std::size_t i = 0; i < disk_.border.size(); ++i)
      if (disk_.border[i] == wall_.foot) start = i;
    for (std::size_t i = 0; i < disk_.border.size(); ++i) {
      const Index v = disk_.border[i];
      fixed[v] = 1;
      at_.height[v] = 1;
      at_.turn[v] = disk_.angle[i] - disk_.angle[start] + (i < start ? k_turn : 0);
    }
  }

  void fix_ring(std::vector<char>& fixed) {
    const std::vector<Index>& ring = wall_.ring;
    std::vector<double> angle;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec3 pole = disk_.where[wall_.pole];
      const Vec3 p = disk_.where[ring[i]] - pole, q = disk_.where[ring[(i + 1) % ring.size()]] - pole;
      angle.push_back(std::atan2(norm(cross(p, q)), dot(p, q)));
    }
    const double mean = std::accumulate(angle.begin(), angle.end(), 0.0) / static_cast<double>(ring.size());
    double total = 0, at = 0;
    for (double& a : angle) total += a = std::max(a, k_least_angle * mean);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      fixed[ring[i]] = 1;
      at_.turn[ring[i]] = k_turn * at / total;
      at += angle[i];
    }
  }

  /// Visits the edges of the wall's triangles: weight, corner, corner.
  template <class Visit>
  void each_edge(Visit visit) const {
    for (std::size_t t = 0; t < disk_.triangles.size(); ++t)
      if (is_wall(t))
        for (std::size_t k = 0; k < 3; ++k) visit(weight(t, k), 3 * t + (k + 1) % 3, 3 * t + (k + 2) % 3);
  }

  bool is_wall(std::size_t t) const {
    const Triangle& c = disk_.triangles[t];
    return std::find(c.begin(), c.end(), wall_.pole) == c.end();
  }

  double weight(std::size_t t, std::size_t k) const {
    const Triangle& c = disk_.triangles[t];
    return cotangent(disk_.where[c[k]], disk_.where[c[(k + 1) % 3]], disk_.where[c[(k + 2) % 3]]);
  }

  Index vertex(std::size_t corner) const { return disk_.triangles[corner / 3][corner % 3]; }
  double turn(std::size_t corner) const { return at_.turn[vertex(corner)] + wall_.turn[corner]; }

  void solve() {
    Elements elements;
    std::vector<Index> triangle_of;
    for (std::size_t t = 0; t < disk_.triangles.size(); ++t) {
      if (!is_wall(t)) continue;
      std::vector<Index> members;
      for (const Index v : disk_.triangles[t])
        if (row_[v] != k_none) members.push_back(row_[v]);
      elements.add(members);
      triangle_of.push_back(static_cast<Index>(t));
    }
    SparseCholesky<double> factor(elements, where_free_, 1);
    factor.factor([&](std::size_t e, double* matrix) {
      const std::size_t t = triangle_of[e];
      double full[3][3] = {};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
        const double w = weight(t, k);
        full[i][i] += w, full[j][j] += w, full[i][j] -= w, full[j][i] -= w;
      }
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 3; ++i)
          if (row_[disk_.triangles[t][i]] != k_none && row_[disk_.triangles[t][j]] != k_none) *matrix++ = full[i][j];
    });
    std::vector<double> right_turn(where_free_.size(), 0), right_height(right_turn);
    each_edge([&](double w, std::size_t a, std::size_t b) {
      for (const auto& [c, d] : {std::pair(a, b), std::pair(b, a)}) {
        const Index row = row_[vertex(c)];
        if (row == k_none) continue;
        // Of vertices that are not known yet, the values are still zero.
        right_turn[row] += w * (turn(d) - wall_.turn[c]);
        right_height[row] += w * at_.height[vertex(d)];
      }
    });
    factor.solve(right_turn);
    factor.solve(right_height);
    for (std::size_t v = 0; v < row_.size(); ++v)
      if (row_[v] != k_none) at_.turn[v] = right_turn[row_[v]], at_.height[v] = right_height[row_[v]];
  }

  /// Turns the ring against the border, and all between by their height, to where the energy is least.
  void untwist() {
    double twist = 0, stiffness = 0;
    each_edge([&](double w, std::size_t a, std::size_t b) {
      const double along = at_.height[vertex(a)] - at_.height[vertex(b)];
      twist += w * along * (turn(a) - turn(b));
      stiffness += w * along * along;
    });
    if (!(stiffness > 0)) return;
    for (std::size_t v = 0; v < at_.turn.size(); ++v) at_.turn[v] += twist / stiffness * (1 - at_.height[v]);
  }

  const FilledDisk& disk_;
  const Wall& wall_;
  std::vector<Index> row_;
  std::vector<Vec3> where_free_;
  Cylinder at_;
};

/// Heights from 0 to 1 between which about the same number of vertices lie; at both ends, where little room may have to
/// do, ever fewer.
std::vector<double> ring_heights(const std::vector<double>& height) {
  std::vector<double> sorted(height), rings{0};
  std::sort(sorted.begin(), sorted.end());
  const std::size_t between = std::max<std::size_t>(1, sorted.size() / k_rings);
  std::vector<std::size_t> ranks;
  for (std::size_t rank = k_least_between; rank < between; rank *= 2) ranks.push_back(rank);
  const std::vector<std::size_t> dense = ranks;
  for (std::size_t rank = between; rank + between <= sorted.size(); rank += between) ranks.push_back(rank);
  for (auto rank = dense.rbegin(); rank != dense.rend(); ++rank) ranks.push_back(sorted.size() - *rank);
  for (const std::size_t rank : ranks)
    if (const double h = sorted[std::min(rank, sorted.size() - 1)]; h > rings.back() && h < 1) rings.push_back(h);
  rings.push_back(1);
  return rings;
}

/// The surface's area below each of the rings.
std::vector<double> areas_below(const FilledDisk& disk, const std::vector<double>& height,
                                const std::vector<double>& rings) {
  std::vector<double> area(rings.size(), 0);
  for (const Triangle& t : disk.triangles) {
    const double own = 0.5 * norm(cross(disk.where[t[1]] - disk.where[t[0]], disk.where[t[2]] - disk.where[t[0]]));
    const auto [low, high] = std::minmax({height[t[0]], height[t[1]], height[t[2]]});
    for (std::size_t k = 0; k < rings.size(); ++k)
      area[k] += rings[k] >= high ? own : rings[k] > low ? own * (rings[k] - low) / (high - low) : 0;
  }
  return area;
}

/// How much the logarithm of the radius has to grow per height between rings so that no triangle turns over in the
/// plane: there, an edge that goes some way around sags inwards, and a vertex below it on the wall has to stay below.
std::vector<double> least_growth(const FilledDisk& disk, const Wall& wall, const Cylinder& cylinder,
                                 const std::vector<double>& rings) {
  std::vector<double> least(rings.size() - 1, 0);
  for (std::size_t t = 0; t < disk.triangles.size(); ++t) {
    const Triangle& corners = disk.triangles[t];
    if (std::find(corners.begin(), corners.end(), wall.pole) != corners.end()) continue;
    std::array<Vec2, 3> p;
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = {cylinder.turn[corners[k]] + wall.turn[3 * t + k], cylinder.height[corners[k]]};
    std::sort(p.begin(), p.end(), [](Vec2 a, Vec2 b) { return a.x < b.x; });
    const double before = p[1].x - p[0].x, after = p[2].x - p[1].x;
    if (!(before > 0 && after > 0)) continue;
    const double gap = (p[0].y * after + p[2].y * before) / (before + after) - p[1].y;
    if (!(gap > 0)) continue;
    const double growth = k_sag_margin * 0.5 * before * after / gap;
    const auto [low, high] = std::minmax({p[0].y, p[1].y, p[2].y});
    for (std::size_t k = 0; k + 1 < rings.size(); ++k)
      if (rings[k] < high && rings[k + 1] > low) least[k] = std::max(least[k], growth);
  }
  return least;
}

}  // namespace

bool has_one_end(const MapLevel& level, std::span<const Vec3> positions) {
  const FilledDisk disk = fill_holes(level, positions);
  const std::vector<double> depth = border_distance(disk).depth;
  // What is deeper than a falling limit: parts appear at their ends, and meet.
  std::vector<Index> order(depth.size()), up(depth.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::iota(up.begin(), up.end(), Index{0});
  const auto deeper = [&](Index a, Index b) { return depth[a] != depth[b] ? depth[a] > depth[b] : a < b; };
  std::sort(order.begin(), order.end(), deeper);
  const auto end_of = [&](Index v) {
    while (up[v] != v) v = up[v] = up[up[v]];
    return v;
  };
  const CornersOfVertices corners(disk.triangles, depth.size());
  const double deepest = depth[order.front()];
  for (const Index v : order)
    for (const Index c : corners.of(v))
      for (const Index w : disk.triangles[c / 3]) {
        if (w == v || !deeper(w, v)) continue;
        Index a = end_of(v), b = end_of(w);
        if (a == b) continue;
        if (deeper(b, a)) std::swap(a, b);
        if (depth[b] - depth[v] > k_second_end * deepest) return false;
        up[b] = a;
      }
  return true;
}

std::optional<TubeMap> map_tube(const MapLevel& level, std::span<const Vec3> positions) {
  const FilledDisk disk = fill_holes(level, positions);
  const Wall wall(disk);
  if (wall.ring.empty()) return {};
  const Cylinder cylinder = WallMap(disk, wall).run();
  const std::vector<double> heights = ring_heights(cylinder.height);
  const std::vector<double> area = areas_below(disk, cylinder.height, heights);
  const std::vector<double> growth = least_growth(disk, wall, cylinder, heights);
  std::vector<double> logarithm(heights.size());
  for (std::size_t k = heights.size(); k-- > 0;) {
    logarithm[k] = 0.5 * std::log(area[k] / std::numbers::pi);
    if (k + 1 < heights.size())
      logarithm[k] = std::min(logarithm[k], logarithm[k + 1] - growth[k] * (heights[k + 1] - heights[k]));
  }
  TubeMap map;
  map.rings.rings = heights.size();
  for (Index v = 0; v < level.vertices.size(); ++v) {
    const double height = cylinder.height[v];
    const auto above = std::upper_bound(heights.begin() + 1, heights.end() - 1, height) - heights.begin();
    const auto k = static_cast<std::size_t>(above) - 1;
    const double share = std::clamp((height - heights[k]) / (heights[k + 1] - heights[k]), 0.0, 1.0);
    const double radius = v == wall.pole ? 0 : std::exp((1 - share) * logarithm[k] + share * logarithm[k + 1]);
    map.uv.push_back(radius * Vec2{std::cos(cylinder.turn[v]), std::sin(cylinder.turn[v])});
    map.rings.place.push_back({static_cast<Index>(k), share});
  }
  return map;
}

}  // namespace papilla::param_detail
