// SPDX-License-Identifier: MIT
#include "papilla/param/lscm.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "chart_driver.hpp"
#include "chart_solvers.hpp"
#include "rest_shape.hpp"
#include "sparse_cholesky.hpp"

namespace papilla::param_detail {
namespace {

using Complex = std::complex<double>;

/// Doubled areas are not taken below this fraction of the longest edge squared: the energy of a triangle
/// grows with its inverse, and one without area must not outweigh all others.
constexpr double k_least_area = 1e-7;

/// The triangle's edges opposite to its corners, in an orthonormal frame of its plane, divided by √(2 · doubled area).
std::array<Complex, 3> weighted_edges(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 p = b - a, q = c - a;
  const double length = norm(p);
  const double along = length > 0 ? dot(p, q) / length : norm(q);
  const double height = length > 0 ? norm(cross(p, q)) / length : 0;
  const double longest = std::max({dot(p, p), dot(q, q), dot(c - b, c - b)});
  if (longest == 0) return {};
  const double weight = 1 / std::sqrt(2 * std::max(length * height, k_least_area * longest));
  const Complex z1(0, 0), z2(length, 0), z3(along, height);
  return {weight * (z3 - z2), weight * (z1 - z3), weight * (z2 - z1)};
}

/// Two vertices of the border that are far apart: the farthest from the first one, and the farthest from that.
std::pair<Index, Index> choose_pins(const ChartSurface& chart, const std::vector<Index>& border) {
  const auto farthest = [&](Index from) {
    return *std::max_element(border.begin(), border.end(), [&](Index x, Index y) {
      const Vec3 p = chart.positions[x] - chart.positions[from], q = chart.positions[y] - chart.positions[from];
      return dot(p, p) < dot(q, q);
    });
  };
  const Index first = farthest(border.front());
  return {first, farthest(first)};
}

}  // namespace

SolvedMap solve_lscm_hermitian(const ChartSurface& chart) {
  const auto [first, second] = choose_pins(chart, border_loops(chart).front());
  const double distance = norm(chart.positions[second] - chart.positions[first]);
  if (!(distance > 0)) return {{}, "the border is a single point"};
  std::vector<Complex> uv(chart.positions.size(), 0);
  uv[second] = distance;
  constexpr Index pinned = ~Index{0};
  std::vector<Index> row(chart.positions.size(), pinned);
  std::vector<Vec3> where;
  for (Index v = 0; v < row.size(); ++v)
    if (v != first && v != second) row[v] = static_cast<Index>(where.size()), where.push_back(chart.positions[v]);

  // The normal equations Wᴴ W over the free vertices; pinned ones move to the right side.
  Elements elements;
  std::vector<Complex> right(where.size(), 0);
  const auto weights = [&](const Triangle& t) {
    return weighted_edges(chart.positions[t[0]], chart.positions[t[1]], chart.positions[t[2]]);
  };
  for (const Triangle& t : chart.triangles) {
    std::vector<Index> free;
    for (std::size_t i = 0; i < 3; ++i) {
      if (row[t[i]] == pinned) continue;
      free.push_back(row[t[i]]);
      for (std::size_t j = 0; j < 3; ++j)
        if (row[t[j]] == pinned) right[row[t[i]]] -= std::conj(weights(t)[i]) * weights(t)[j] * uv[t[j]];
    }
    elements.add(free);
  }
  SparseCholesky<Complex> factor(elements, where, 1);
  factor.factor([&](std::size_t e, Complex* matrix) {
    const Triangle& t = chart.triangles[e];
    const auto w = weights(t);
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t i = 0; i < 3; ++i)
        if (row[t[i]] != pinned && row[t[j]] != pinned) *matrix++ = std::conj(w[i]) * w[j];
  });
  factor.solve(right);
  for (std::size_t v = 0; v < row.size(); ++v)
    if (row[v] != pinned) uv[v] = right[row[v]];
  SolvedMap map;
  map.uv.reserve(uv.size());
  for (const Complex z : uv) map.uv.push_back({z.real(), z.imag()});
  return map;
}

}  // namespace papilla::param_detail

namespace papilla {
namespace {

using namespace param_detail;

/// Σ A (σ1 - σ2)² = Σ A (|J|² - 2 det J) of the map scaled to the chart's area.
double conformal_energy(const ChartSurface& chart, const std::vector<Vec2>& uv) {
  const std::vector<RestShape> rest = rest_shapes(chart.positions, chart.triangles);
  double energy = 0, uv_area = 0, area = 0;
  for (std::size_t t = 0; t < rest.size(); ++t) {
    const auto& [a, b, c] = chart.triangles[t];
    const Jacobian j = jacobian(rest[t], uv[b] - uv[a], uv[c] - uv[a]);
    energy += rest[t].area * (j.squared() - 2 * j.determinant());
    uv_area += rest[t].area * j.determinant();
    area += rest[t].area;
  }
  return uv_area > 0 ? std::max(energy, 0.0) * area / uv_area : 0;
}

}  // namespace

Flattening flatten_lscm(const TriangleMesh& mesh, const ChartSet& charts, const LscmOptions& options) {
  const auto method = [&](const ChartSurface& chart) {
    const Stopwatch clock;
    SolvedMap solution = options.solver == LscmSolver::cgal ? solve_lscm_cgal(chart) : solve_lscm_hermitian(chart);
    ChartMap map{std::move(solution.uv), std::move(solution.failure), StopReason::direct, {}};
    if (map.failure.empty()) map.trace.push_back({clock.seconds(), conformal_energy(chart, map.uv)});
    return map;
  };
  return flatten_charts(mesh, charts, method, driver_options("flatten_lscm", options));
}

}  // namespace papilla
