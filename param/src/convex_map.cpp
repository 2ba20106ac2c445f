// SPDX-License-Identifier: MIT
#include "convex_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "adjacency.hpp"
#include "disk_borders.hpp"
#include "sparse_cholesky.hpp"

namespace papilla::param_detail {
namespace {

/// How much edges pull. A uniform pull shrinks a finger by a factor per ring of edges, below what numbers resolve when
/// it is long. What leads away from the border pulls harder where the disk is deeper than its border is wide: by the
/// square of that ratio, which leaves a finger of any length about one such factor in all.
class Pull {
 public:
  explicit Pull(const FilledDisk& disk) : where_(disk.where), depth_(border_distance(disk).depth) {
    const double deepest = *std::max_element(depth_.begin(), depth_.end());
    const double ratio = 2 * std::numbers::pi * deepest / disk.border_length;
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
  const FilledDisk disk = fill_holes(level, positions);
  const double radius = std::sqrt(level.area / std::numbers::pi);
  std::vector<Vec2> uv(disk.where.size());
  std::vector<char> fixed(disk.where.size(), 0);
  for (std::size_t i = 0; i < disk.border.size(); ++i) {
    fixed[disk.border[i]] = 1;
    uv[disk.border[i]] = radius * Vec2{std::cos(disk.angle[i]), std::sin(disk.angle[i])};
  }
  average(disk.triangles, fixed, disk.where, Pull(disk), uv);
  uv.resize(level.vertices.size());
  return uv;
}

}  // namespace papilla::param_detail
