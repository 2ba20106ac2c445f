// SPDX-License-Identifier: MIT
#include "papilla/param/reference_maps.hpp"

#include <cmath>
#include <string>

#include "chart_driver.hpp"
#include "chart_solvers.hpp"
#include "map_descent.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using namespace param_detail;

constexpr const char* k_function = "flatten_reference";

void check(const ReferenceOptions& options) {
  const auto refuse = [](const std::string& what) { throw InvalidInput(std::string(k_function) + ": " + what); };
  if (!(options.arap_lambda >= 0 && options.arap_lambda <= 1e12))
    refuse("arap_lambda is " + std::to_string(options.arap_lambda) + ", it must lie between 0 and 1e12");
  if (options.arap_iterations < 1)
    refuse("arap_iterations is " + std::to_string(options.arap_iterations) + ", it must be at least 1");
  if (!(options.arap_tolerance >= 0 && options.arap_tolerance < 1))
    refuse("arap_tolerance is " + std::to_string(options.arap_tolerance) + ", it must lie in [0, 1)");
}

SolvedMap solve(const ChartSurface& chart, const ReferenceOptions& options) {
  switch (options.map) {
    case ReferenceMap::tutte: return solve_tutte_cgal(chart);
    case ReferenceMap::mean_value: return solve_mean_value_cgal(chart);
    case ReferenceMap::arap:
      return solve_arap_cgal(chart, {options.arap_lambda, options.arap_iterations, options.arap_tolerance});
  }
  return {{}, "there is no such map"};
}

}  // namespace

Flattening flatten_reference(const TriangleMesh& mesh, const ChartSet& charts, const ReferenceOptions& options) {
  check(options);
  const auto method = [&](const ChartSurface& chart) {
    const Stopwatch clock;
    // CGAL's ARAP compares energies with an absolute number: a chart of area 1 makes it relative.
    SolvedMap solution = solve(to_unit(chart).surface, options);
    ChartMap map{std::move(solution.uv), std::move(solution.failure), StopReason::direct, {}, false};
    if (!map.failure.empty()) return map;
    const double seconds = clock.seconds();
    std::vector<Vec2> scaled = map.uv;
    normalise(chart, options.up, true, scaled);
    const std::vector<RestShape> rest = rest_shapes(chart.positions, chart.triangles);
    const SymmetricDirichlet energy(rest);
    // Infinite where a triangle is flipped, also one without area in space.
    const double reached = total_energy({chart.triangles, &energy}, scaled);
    if (std::isfinite(reached)) map.trace.push_back({seconds, reached});
    return map;
  };
  return flatten_charts(mesh, charts, method, driver_options(k_function, options));
}

}  // namespace papilla
