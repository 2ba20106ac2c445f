// SPDX-License-Identifier: MIT
#include "convex_map.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <queue>
#include <utility>

#include "adjacency.hpp"
#include "sparse_cholesky.hpp"

namespace papilla::param_detail {
namespace {

/// Edges of the border count as at least this fraction of their mean length.
constexpr double k_least_border_edge = 0.3;

using Loop = std::vector<Index>;

std::vector<Loop> loops_of(std::span<const BorderPair> border, std::size_t vertices) {
  std::vector<Index> after(vertices, k_no_triangle);
  for (const auto& [from, to] : border) after[from] = to;
  std::vector<Loop> loops;
  for (Index start = 0; start < vertices; ++start) {
    if (after[start] == k_no_triangle) continue;
    Loop& loop = loops.emplace_back();
    for (Index v = start; after[v] != k_no_triangle;) {
      loop.push_back(v);
      v = std::exchange(after[v], k_no_triangle);
    }
  }
  return loops;
}

void put_on_circle(const Loop& loop, const std::vector<double>& lengths, double radius, std::vector<Vec2>& uv) {
  double total = 0, mean = 0;
  for (const double length : lengths) mean += length / static_cast<double>(lengths.size());
  for (const double length : lengths) total += std::max(length, k_least_border_edge * mean);
  double at = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const double angle = 2 * std::numbers::pi * at / total;
    uv[loop[i]] = radius * Vec2{std::cos(angle), std::sin(angle)};
    at += std::max(lengths[i], k_least_border_edge * mean);
  }
}

/// The distance of each vertex from the nearest fixed one along edges.
std::vector<double> depths(std::span<const Triangle> triangles, const std::vector<char>& fixed,
                           std::span<const Vec3> where) {
  std::vector<std::vector<Index>> neighbors(where.size());
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      neighbors[t[k]].push_back(t[(k + 1) % 3]);
      neighbors[t[(k + 1) % 3]].push_back(t[k]);
    }
  std::vector<double> depth(where.size(), std::numeric_limits<double>::infinity());
  using Reached = std::pair<double, Index>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
  for (Index v = 0; v < where.size(); ++v)
    if (fixed[v]) depth[v] = 0, queue.emplace(0, v);
  while (!queue.empty()) {
    const auto [distance, v] = queue.top();
    queue.pop();
    if (distance > depth[v]) continue;
    for (const Index w : neighbors[v])
      if (const double by_v = distance + norm(where[w] - where[v]); by_v < depth[w])
        depth[w] = by_v, queue.emplace(by_v, w);
  }
  return depth;
}

/// How much edges pull. A uniform pull shrinks a finger by a factor per ring of edges, below what numbers resolve when
/// it is long. What leads away from the border pulls harder where the disk is deeper than its border is wide: by the
/// square of that ratio, which leaves a finger of any length about one such factor in all.
class Pull {
 public:
  Pull(std::span<const Triangle> triangles, const std::vector<char>& fixed, std::span<const Vec3> where,
       double border_length)
      : where_(where), depth_(depths(triangles, fixed, where)) {
    const double deepest = *std::max_element(depth_.begin(), depth_.end());
    const double ratio = 2 * std::numbers::pi * deepest / border_length;
    if (ratio > 1 && std::isfinite(ratio)) along_depth_ = ratio * ratio - 1;
  }

  double operator()(Index v, Index w) const {
    const Vec3 edge = where_[w] - where_[v];
    const double squared = dot(edge, edge), deeper = depth_[w] - depth_[v];
    return squared > 0 ? 1 + along_depth_ * std::min(1.0, deeper * deeper / squared) : 1;
  }

 private:
  std::span<const Vec3> where_;
  std::vector<double> depth_;
  double along_depth_ = 0;
};

/// Every free vertex at the mean of its neighbours, weighted by the pull (edges of two triangles count twice).
void average(std::span<const Triangle> triangles, const std::vector<char>& fixed, std::span<const Vec3> where,
             const Pull& pull, std::vector<Vec2>& uv) {
  std::vector<Index> row(uv.size(), k_no_triangle);
  std::vector<Vec3> where_free;
  for (Index v = 0; v < uv.size(); ++v)
    if (!fixed[v]) row[v] = static_cast<Index>(where_free.size()), where_free.push_back(where[v]);
  if (where_free.empty()) return;
  Elements elements;
  std::vector<Vec2> right(where_free.size());
  for (const Triangle& t : triangles) {
    std::vector<Index> members;
    for (const Index v : t) {
      if (fixed[v]) continue;
      members.push_back(row[v]);
      for (const Index w : t)
        if (fixed[w]) right[row[v]] = right[row[v]] + pull(v, w) * uv[w];
    }
    elements.add(members);
  }
  SparseCholesky<double> factor(elements, where_free, 1);
  factor.factor([&](std::size_t e, double* matrix) {
    for (const Index v : triangles[e]) {
      if (fixed[v]) continue;
      double sum = 0, *diagonal = nullptr;
      for (const Index w : triangles[e]) {
        if (w != v) sum += pull(v, w);
        if (fixed[w]) continue;
        if (w == v) diagonal = matrix;
        *matrix++ = -pull(v, w);
      }
      *diagonal = sum;
    }
  });
  std::vector<double> x(right.size());
  for (double Vec2::*axis : {&Vec2::x, &Vec2::y}) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = right[i].*axis;
    factor.solve(x);
    for (std::size_t v = 0; v < uv.size(); ++v)
      if (!fixed[v]) uv[v].*axis = x[row[v]];
  }
}

}  // namespace

std::vector<Vec2> map_to_circle(const MapLevel& level, std::span<const Vec3> positions) {
  const auto at = [&](Index v) { return positions[level.vertices[v]]; };
  std::vector<Loop> loops = loops_of(level.border, level.vertices.size());
  std::vector<double> longest;
  double longest_sum = -1;
  std::size_t outer = 0;
  for (std::size_t l = 0; l < loops.size(); ++l) {
    std::vector<double> lengths;
    double sum = 0;
    for (std::size_t i = 0; i < loops[l].size(); ++i) {
      lengths.push_back(norm(at(loops[l][(i + 1) % loops[l].size()]) - at(loops[l][i])));
      sum += lengths.back();
    }
    if (sum > longest_sum) longest_sum = sum, longest = std::move(lengths), outer = l;
  }
  std::vector<Triangle> triangles = level.triangles;
  std::vector<Vec3> where;
  for (const Index v : level.vertices) where.push_back(positions[v]);
  for (std::size_t l = 0; l < loops.size(); ++l) {
    if (l == outer) continue;
    const auto middle = static_cast<Index>(where.size());
    where.push_back(at(loops[l].front()));
    for (std::size_t i = 0; i < loops[l].size(); ++i)
      triangles.push_back({loops[l][(i + 1) % loops[l].size()], loops[l][i], middle});
  }
  std::vector<Vec2> uv(where.size());
  std::vector<char> fixed(where.size(), 0);
  for (const Index v : loops[outer]) fixed[v] = 1;
  put_on_circle(loops[outer], longest, std::sqrt(level.area / std::numbers::pi), uv);
  average(triangles, fixed, where, Pull(triangles, fixed, where, longest_sum), uv);
  uv.resize(level.vertices.size());
  return uv;
}

}  // namespace papilla::param_detail
