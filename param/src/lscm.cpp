// SPDX-License-Identifier: MIT
#include "papilla/param/lscm.hpp"

#include <algorithm>

#include "chart_driver.hpp"
#include "lscm_solvers.hpp"
#include "rest_shape.hpp"

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
    ConformalMap solution = options.solver == LscmSolver::cgal ? solve_lscm_cgal(chart) : solve_lscm_hermitian(chart);
    ChartMap map{std::move(solution.uv), std::move(solution.failure), StopReason::direct, {}};
    if (map.failure.empty()) map.trace.push_back({clock.seconds(), conformal_energy(chart, map.uv)});
    return map;
  };
  return flatten_charts(mesh, charts, method, driver_options("flatten_lscm", options));
}

}  // namespace papilla
