// SPDX-License-Identifier: MIT
#include "papilla/param/best.hpp"

#include <string>

#include "chart_driver.hpp"
#include "multilevel_map.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using namespace param_detail;

constexpr const char* k_function = "flatten_best";

}  // namespace

void param_detail::check_best_options(const BestOptions& options, std::string_view function) {
  const auto refuse = [&](const std::string& what) { throw InvalidInput(std::string(function) + ": " + what); };
  if (!(options.tolerance > 0 && options.tolerance < 1))
    refuse("tolerance is " + std::to_string(options.tolerance) + ", it must lie between 0 and 1");
  if (options.max_iterations < 0)
    refuse("max_iterations is " + std::to_string(options.max_iterations) + ", it must not be negative");
  if (!(options.energy_limit >= 4))
    refuse("energy_limit is " + std::to_string(options.energy_limit) + ", it must be at least 4");
}

MultilevelOptions param_detail::multilevel_options(const BestOptions& options) {
  MultilevelOptions result;
  result.max_iterations = options.max_iterations;
  result.tolerance = options.tolerance;
  result.deadline = options.deadline;
  result.energy_limit = options.energy_limit;
  return result;
}

Flattening flatten_best(const TriangleMesh& mesh, const ChartSet& charts, const BestOptions& options) {
  check_best_options(options, k_function);
  const auto method = [&](const ChartSurface& chart) {
    const UnitChart unit = to_unit(chart);
    MultilevelMap solution = map_multilevel(unit.surface, multilevel_options(options));
    ChartMap map{std::move(solution.uv), std::move(solution.failure), solution.stop, std::move(solution.trace)};
    // From per unit of area to the sum over the chart.
    for (TraceSample& sample : map.trace) sample.error *= area_of(chart);
    return map;
  };
  return flatten_charts(mesh, charts, method, driver_options(k_function, options));
}

}  // namespace papilla
