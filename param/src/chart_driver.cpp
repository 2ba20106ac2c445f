// SPDX-License-Identifier: MIT
#include "chart_driver.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>
#include <utility>

#include "check_mesh.hpp"
#include "mapped_chart.hpp"
#include "multilevel_map.hpp"
#include "papilla/core/error.hpp"

namespace papilla::param_detail {
namespace {

MappedChart map_chart(const ChartSurface& chart, const ChartMethod& method, const DriverOptions& options) {
  MappedChart result;
  result.failure = topology_failure(chart);
  result.wrong_topology = !result.failure.empty();
  result.area = area_of(chart);
  if (result.wrong_topology) return result;
  if (!(result.area > 0)) {
    result.failure = "it has no area";
    return result;
  }
  if (options.fall_back && options.deadline.passed()) {
    result.failure = "no time is left";
    result.stop = StopReason::time_limit;
    return result;
  }
  ChartMap map = method(chart);
  result.choice = std::move(map.choice);
  result.failure = map.failure;
  if (!result.failure.empty()) {
    if (map.stop == StopReason::time_limit || options.deadline.passed()) result.stop = StopReason::time_limit;
    result.refused = std::move(map.uv);
    return result;
  }
  if (!map.keep_place) normalise(chart, options.up, options.scale_to_area, map.uv);
  result.given_up = map.given_up;
  if (!options.allow_flips && !map.given_up) result.failure = map_failure(chart, map.uv);
  if (!result.failure.empty()) return result;
  result.stop = map.stop;
  result.trace = std::move(map.trace);
  result.uv = {adopted_values(std::move(map.uv)), chart.triangles};
  return result;
}

/// A map of low distortion, for a chart that the method has no valid one for.
bool unfold_instead(const ChartSurface& chart, const DriverOptions& options, MappedChart& result) {
  if (result.wrong_topology || !(result.area > 0)) return false;
  std::vector<Vec2> uv = std::move(result.refused);
  if (uv.empty()) {
    if (!options.unfold || options.deadline.passed()) return false;
    MultilevelOptions multilevel;
    multilevel.deadline = options.deadline;
    MultilevelMap map = map_multilevel(to_unit(chart).surface, multilevel);
    const bool out_of_time = !map.failure.empty() && options.deadline.passed();
    if (map.stop == StopReason::time_limit || out_of_time) result.stop = StopReason::time_limit;
    if (!map.failure.empty()) return false;
    uv = std::move(map.uv);
  }
  normalise(chart, options.up, true, uv);
  if (!map_failure(chart, uv).empty()) return false;
  result.uv = {adopted_values(std::move(uv)), chart.triangles};
  result.instead = "mapped with least distortion instead";
  return true;
}

void project_instead(const ChartSurface& chart, const DriverOptions& options, MappedChart& result) {
  TriangleMesh mesh;
  mesh.positions = chart.positions;
  mesh.triangles = chart.triangles;
  TriplanarOptions projection = options.projection;
  projection.up = options.up;
  TriplanarResult projected = flatten_triplanar(mesh, projection);
  result.uv = std::move(projected.flattening.uv);
  result.pieces = std::move(projected.flattening.charts.of_triangle);
  result.piece_count = projected.flattening.charts.count;
  result.instead = "projected as " + std::to_string(result.piece_count) + " planar pieces instead";
}

std::vector<std::array<Vec2, 3>> corners_of(const CornerAttribute<Vec2>& uv, std::span<const Index> triangles) {
  std::vector<std::array<Vec2, 3>> corners;
  corners.reserve(triangles.size());
  for (const Index t : triangles) {
    const auto [a, b, c] = uv.indices[t];
    corners.push_back({uv.values[a], uv.values[b], uv.values[c]});
  }
  return corners;
}

void append(const MappedChart& chart, std::span<const Index> triangles, Flattening& result) {
  const auto first_value = static_cast<Index>(result.uv.values.size());
  result.uv.values.insert(result.uv.values.end(), chart.uv.values.begin(), chart.uv.values.end());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& corners = chart.uv.indices[i];
    result.uv.indices[triangles[i]] = {first_value + corners[0], first_value + corners[1], first_value + corners[2]};
    result.charts.of_triangle[triangles[i]] = result.charts.count + (chart.pieces.empty() ? 0 : chart.pieces[i]);
  }
  result.charts.count += chart.piece_count;
}

/// The sum of curves that run side by side; each holds its last value.
Trace add_up(const std::vector<MappedChart>& mapped, bool per_area) {
  struct Event {
    double seconds, change;
  };
  std::vector<Event> events;
  double error = 0, area = 0;
  for (const MappedChart& chart : mapped) {
    if (!chart.failure.empty() || chart.trace.empty()) continue;
    error += chart.trace.front().error;
    area += chart.area;
    for (std::size_t i = 1; i < chart.trace.size(); ++i)
      events.push_back({chart.trace[i].seconds, chart.trace[i].error - chart.trace[i - 1].error});
  }
  if (area == 0) return {{0, 0}};
  std::stable_sort(events.begin(), events.end(), [](const Event& a, const Event& b) { return a.seconds < b.seconds; });
  const double scale = per_area ? 1 / area : 1;
  Trace trace{{0, scale * error}};
  if (mapped.size() == 1) trace.front().seconds = mapped.front().trace.front().seconds;
  for (const Event& e : events) trace.push_back({e.seconds, scale * (error += e.change)});
  return trace;
}

}  // namespace

std::vector<ChartChoice> choices_of_charts(std::vector<MethodChoice> choices) {
  std::vector<ChartChoice> result;
  for (std::uint32_t c = 0; c < choices.size(); ++c)
    if (!choices[c].method.empty()) result.push_back({c, std::move(choices[c].method), std::move(choices[c].reason)});
  return result;
}

Flattening flatten_charts(const TriangleMesh& mesh, const ChartSet& charts, const ChartMethod& method,
                          const DriverOptions& options) {
  check_mesh(mesh, options.function);
  check_charts(mesh, charts, options.function);
  Adjacency across;
  TrianglesOfCharts members;
  oneapi::tbb::parallel_invoke([&] { across = connect_triangles(mesh); },
                               [&] { members = sort_by_chart(charts.of_triangle, charts.count); });
  const ChartCutter cutter(mesh, across, charts);
  std::vector<MappedChart> mapped(charts.count);
  oneapi::tbb::parallel_for(std::uint32_t{0}, charts.count, [&](std::uint32_t c) {
    if (members.of(c).empty()) return;
    ChartSurface surface = cutter.cut(c, members.of(c));
    if (options.memory && options.memory->maps().recall(members.of(c), surface, options.energy_limit, mapped[c])) {
      if (options.choices) (*options.choices)[c] = mapped[c].choice;
      return;
    }
    if (options.nearby) surface.nearby = corners_of(*options.nearby, members.of(c));
    mapped[c] = map_chart(surface, method, options);
    if (options.choices) (*options.choices)[c] = mapped[c].choice;
    if (mapped[c].failure.empty() || !options.fall_back) return;
    if (!unfold_instead(surface, options, mapped[c])) project_instead(surface, options, mapped[c]);
  });

  Flattening result;
  result.trace = add_up(mapped, options.error_per_area);
  result.uv.indices.resize(mesh.triangles.size());
  result.charts.of_triangle.resize(mesh.triangles.size());
  for (std::uint32_t c = 0; c < charts.count; ++c) {
    const auto own = members.of(c);
    if (own.empty()) continue;
    result.stop = worse(result.stop, mapped[c].stop);
    if (!mapped[c].failure.empty()) {
      const std::string what =
          "chart[" + std::to_string(c) + "] (triangle[" + std::to_string(own.front()) + "]): " + mapped[c].failure;
      if (!options.fall_back) {
        const std::string message = std::string(options.function) + ": " + what;
        if (mapped[c].wrong_topology) throw InvalidInput(message);
        throw SolverFailure(message);
      }
      result.notes.push_back({c, what + "; " + mapped[c].instead});
    }
    append(mapped[c], own, result);
    if (options.memory) options.memory->maps().keep(own, std::move(mapped[c]));
    mapped[c] = {};
  }
  result.charts.seam_length_mm = seam_length(mesh, across, result.charts.of_triangle);
  return result;
}

}  // namespace papilla::param_detail
