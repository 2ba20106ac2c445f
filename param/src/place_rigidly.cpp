// SPDX-License-Identifier: MIT
#include "place_rigidly.hpp"

#include <utility>

#include "rest_shape.hpp"
#include "sparse_cholesky.hpp"

namespace papilla::param_detail {
namespace {

/// As often triangles may turn once more.
constexpr int k_turns = 3;

/// What holds a vertex that stays, over what holds triangles together; and what holds the others, where nothing stays.
constexpr double k_hold = 1e8, k_anchor = 1e-9;

/// The triangles of some vertices as a mesh of its own.
struct Patch {
  std::vector<Index> vertices;   ///< Of the chart: those that are free first.
  std::vector<Index> triangles;  ///< Of the chart.
  std::vector<Triangle> local;   ///< The same, of the patch's vertices.
};

Patch patch_of(const ChartSurface& chart, const CornersOfVertices& corners, std::span<const Index> free) {
  constexpr Index nowhere = ~Index{0};
  Patch patch{{free.begin(), free.end()}, {}, {}};
  std::vector<Index> number(chart.positions.size(), nowhere);
  std::vector<char> taken(chart.triangles.size(), 0);
  for (Index i = 0; i < free.size(); ++i) number[free[i]] = i;
  for (const Index v : free)
    for (const Index c : corners.of(v))
      if (!std::exchange(taken[c / 3], 1)) patch.triangles.push_back(c / 3);
  for (const Index t : patch.triangles) {
    Triangle& own = patch.local.emplace_back(chart.triangles[t]);
    for (Index& v : own) {
      if (number[v] == nowhere) {
        number[v] = static_cast<Index>(patch.vertices.size());
        patch.vertices.push_back(v);
      }
      v = number[v];
    }
  }
  return patch;
}

/// The rotation of `shape` that is nearest to `now`.
Jacobian turned_to(const Jacobian& now, const Jacobian& shape) {
  const Vec2 turn{dot(shape.x, now.x) + dot(shape.y, now.y), cross(shape.x, now.x) + cross(shape.y, now.y)};
  const double length = norm(turn);
  if (!(length > 0)) return shape;
  return {turned(shape.x, (1 / length) * turn), turned(shape.y, (1 / length) * turn)};
}

}  // namespace

void place_rigidly(const ChartSurface& chart, const CornersOfVertices& corners,
                   std::span<const std::array<Vec2, 3>> shapes, std::span<const Index> free, std::vector<Vec2>& uv) {
  const Patch patch = patch_of(chart, corners, free);
  const double least = least_edge(chart.positions, chart.triangles);
  std::vector<RestShape> rest;
  std::vector<Jacobian> own;
  for (const Index t : patch.triangles) {
    const auto [a, b, c] = chart.triangles[t];
    rest.push_back(rest_shape(chart.positions[a], chart.positions[b], chart.positions[c], least));
    own.push_back(jacobian(rest.back(), shapes[t][1] - shapes[t][0], shapes[t][2] - shapes[t][0]));
  }
  std::vector<Vec3> where;
  for (const Index v : patch.vertices) where.push_back({uv[v].x, uv[v].y, 0});
  const auto hold = [&](Index i) { return i < free.size() ? k_anchor : k_hold; };
  SparseCholesky<double> laplacian(elements_of(patch.local), where, 1);
  laplacian.factor([&](std::size_t t, double* matrix) {
    const CornerFactors f = corner_factors(rest[t]);
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t i = 0; i < 3; ++i) matrix[3 * j + i] = rest[t].area * (f[i][0] * f[j][0] + f[i][1] * f[j][1]);
      matrix[4 * j] += hold(patch.local[t][j]);
    }
  });
  std::vector<Jacobian> wanted = own;
  std::vector<double> x(patch.vertices.size()), y(x.size());
  for (int turn = 0; turn <= k_turns; ++turn) {
    std::fill(x.begin(), x.end(), 0);
    std::fill(y.begin(), y.end(), 0);
    for (std::size_t t = 0; t < patch.local.size(); ++t) {
      const CornerFactors f = corner_factors(rest[t]);
      for (std::size_t k = 0; k < 3; ++k) {
        const Index i = patch.local[t][k];
        const Vec2 pull = rest[t].area * (f[k][0] * wanted[t].x + f[k][1] * wanted[t].y);
        const Vec2 right = pull + hold(i) * uv[patch.vertices[i]];
        x[i] += right.x, y[i] += right.y;
      }
    }
    laplacian.solve(x);
    laplacian.solve(y);
    for (std::size_t i = 0; i < free.size(); ++i) uv[patch.vertices[i]] = {x[i], y[i]};
    for (std::size_t t = 0; t < patch.local.size(); ++t) {
      const auto [a, b, c] = chart.triangles[patch.triangles[t]];
      wanted[t] = turned_to(jacobian(rest[t], uv[b] - uv[a], uv[c] - uv[a]), own[t]);
    }
  }
}

}  // namespace papilla::param_detail
