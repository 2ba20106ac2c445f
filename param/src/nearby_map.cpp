// SPDX-License-Identifier: MIT
#include "nearby_map.hpp"

#include <cmath>
#include <utility>

#include "map_descent.hpp"
#include "papilla/core/trace.hpp"
#include "stitched_start.hpp"

namespace papilla::param_detail {
namespace {

/// What one cut changes is less than what a map from nothing may still gain.
constexpr double k_finer = 0.3;

}  // namespace

std::optional<MultilevelMap> map_nearby(const ChartSurface& chart, const MultilevelOptions& options) {
  if (options.max_iterations == 0 || chart.positions.size() > options.newton_vertices) return {};
  const Stopwatch clock;
  std::optional<std::vector<Vec2>> uv = stitched_start(chart);
  if (!uv) return {};
  const std::vector<RestShape> rest = rest_shapes(chart.positions, chart.triangles);
  double area = 0;
  for (const RestShape& shape : rest) area += shape.area;
  const SymmetricDirichlet energy(rest);
  const BorderBarrier barrier =
      barrier_of(border_of(chart.triangles, chart.positions.size()), *uv, area, chart.triangles.size());
  if (!barrier.is_simple(*uv)) return {};
  DescentOptions descent;
  descent.max_iterations = options.max_iterations;
  descent.tolerance = k_finer * options.tolerance;
  descent.from_far = true;
  descent.foresee = true;
  descent.deadline = options.deadline;
  descent.give_up_energy = options.give_up_energy * area;
  const double begin = clock.seconds();
  const DescentResult result = descend({chart.triangles, &energy, &barrier}, *uv, descent);
  MultilevelMap map;
  map.given_up = result.energy > descent.give_up_energy;
  if (!std::isfinite(result.energy) || (result.stop == StopReason::line_search_stalled && !map.given_up)) return {};
  map.uv = std::move(*uv);
  map.stop = result.stop;
  for (const TraceSample& sample : result.trace) map.trace.push_back({begin + sample.seconds, sample.error / area});
  return map;
}

}  // namespace papilla::param_detail
