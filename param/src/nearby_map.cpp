// SPDX-License-Identifier: MIT
#include "nearby_map.hpp"

#include <cmath>
#include <utility>

#include "map_descent.hpp"
#include "map_level.hpp"
#include "papilla/core/trace.hpp"
#include "stitched_start.hpp"

namespace papilla::param_detail {
namespace {

/// What one cut changes is less than what a map from nothing may still gain.
constexpr double k_finer = 0.3;

/// Above this mean energy a start has triangles that are all but turned over. Newton's method takes ten steps and more
/// to get rid of them, or is stopped by the border; sweeps over the vertices, each a sixth of the time of a step, do it
/// first.
constexpr double k_rough = 4.2;
constexpr int k_sweeps = 8;
constexpr double k_relax_tolerance = 3e-3;

}  // namespace

std::optional<MultilevelMap> map_nearby(const ChartSurface& chart, const MultilevelOptions& options) {
  if (options.max_iterations == 0 || chart.positions.size() > options.newton_vertices) return {};
  const Stopwatch clock;
  std::optional<std::vector<Vec2>> start = stitched_start(chart);
  if (!start) return {};
  MapLevel level = whole_level(chart, std::move(*start));
  const SymmetricDirichlet energy(level.rest);
  if (!barrier_of(level).is_simple(level.uv)) return {};
  if (total_energy({level.triangles, &energy, nullptr}, level.uv) > k_rough * level.area)
    relax(level, k_sweeps, k_relax_tolerance, true);
  const BorderBarrier barrier = barrier_of(level);
  DescentOptions descent;
  descent.max_iterations = options.max_iterations;
  descent.tolerance = k_finer * options.tolerance;
  descent.from_far = true;
  descent.foresee = true;
  descent.deadline = options.deadline;
  descent.give_up_energy = options.give_up_energy * level.area;
  const double begin = clock.seconds();
  const DescentResult result = descend({level.triangles, &energy, &barrier}, level.uv, descent);
  MultilevelMap map;
  map.given_up = result.energy > descent.give_up_energy;
  if (!std::isfinite(result.energy) || (result.stop == StopReason::line_search_stalled && !map.given_up)) return {};
  map.uv = std::move(level.uv);
  map.stop = result.stop;
  for (const TraceSample& sample : result.trace)
    map.trace.push_back({begin + sample.seconds, sample.error / level.area});
  return map;
}

}  // namespace papilla::param_detail
