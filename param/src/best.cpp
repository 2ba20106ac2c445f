// SPDX-License-Identifier: MIT
#include "papilla/param/best.hpp"

#include <string>

#include "best_map.hpp"
#include "check_mesh.hpp"
#include "multilevel_map.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using namespace param_detail;

constexpr const char* k_function = "flatten_best";

/// @param area of the chart.
MultilevelOptions multilevel_options(const BestOptions& options, double area) {
  MultilevelOptions result;
  result.max_iterations = options.max_iterations;
  result.tolerance = options.tolerance;
  result.newton_vertices = options.newton_vertices;
  result.deadline = options.deadline;
  result.energy_limit = options.energy_limit;
  result.give_up_energy = 4 + options.give_up_excess_mm2 / area;
  return result;
}

}  // namespace

void param_detail::check_best_options(const BestOptions& options, std::string_view function) {
  const auto refuse = [&](const std::string& what) { throw InvalidInput(std::string(function) + ": " + what); };
  if (!(options.tolerance > 0 && options.tolerance < 1))
    refuse("tolerance is " + std::to_string(options.tolerance) + ", it must lie between 0 and 1");
  if (options.max_iterations < 0)
    refuse("max_iterations is " + std::to_string(options.max_iterations) + ", it must not be negative");
  if (!(options.energy_limit >= 4))
    refuse("energy_limit is " + std::to_string(options.energy_limit) + ", it must be at least 4");
  if (!(options.give_up_excess_mm2 >= 0))
    refuse("give_up_excess_mm2 is " + std::to_string(options.give_up_excess_mm2) + ", it must not be negative");
}

ChartMap param_detail::map_best(const ChartSurface& chart, const BestOptions& options, SharedProgress& mapped) {
  WorkProgress work(mapped, static_cast<double>(chart.triangles.size()));
  const double area = area_of(chart);
  MultilevelOptions multilevel = multilevel_options(options, area);
  multilevel.progress = [&](double fraction) { work.reach(fraction); };
  MultilevelMap solution = map_multilevel(to_unit(chart).surface, multilevel);
  ChartMap map{std::move(solution.uv), std::move(solution.failure), solution.stop, std::move(solution.trace)};
  map.given_up = solution.given_up;
  // From per unit of area to the sum over the chart.
  for (TraceSample& sample : map.trace) sample.error *= area;
  work.reach(1);
  return map;
}

Flattening flatten_best(const TriangleMesh& mesh, const ChartSet& charts, const BestOptions& options) {
  check_best_options(options, k_function);
  if (options.nearby) check_uv(mesh, *options.nearby, k_function);
  SharedProgress mapped(options.progress, "map", static_cast<double>(mesh.triangles.size()));
  DriverOptions driver = driver_options(k_function, options);
  driver.unfold = false;
  return flatten_charts(
      mesh, charts, [&](const ChartSurface& chart) { return map_best(chart, options, mapped); }, driver);
}

}  // namespace papilla
