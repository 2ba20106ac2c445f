// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "disk_chart.hpp"
#include "papilla/core/deadline.hpp"
#include "papilla/param/chart_choice.hpp"
#include "papilla/param/chart_memory.hpp"
#include "papilla/param/flattening.hpp"
#include "papilla/param/triplanar.hpp"

namespace papilla::param_detail {

/// Which of several methods a chart got, and why.
struct MethodChoice {
  std::string method, reason;
};

/// The map of one chart, or why there is none.
struct ChartMap {
  /// Per vertex of the chart; when `failure` says why there is none, empty, or a valid map of too much distortion.
  std::vector<Vec2> uv;
  std::string failure;
  StopReason stop = StopReason::direct;
  Trace trace;               ///< Error: what the method minimises, summed over the chart; seconds since its start.
  bool keep_place = false;   ///< Do not scale and turn: the caller said where it goes.
  MethodChoice choice = {};  ///< Of methods that choose.
  bool given_up = false;     ///< It is of no use, and need not be injective.
};

using ChartMethod = std::function<ChartMap(const ChartSurface&)>;

struct DriverOptions {
  std::string_view function;  ///< Name in messages.
  UpAxis up = UpAxis::z;
  bool scale_to_area = true;
  bool allow_flips = false;  ///< Flipped triangles and overlap are results, not failures.
  bool unfold = true;        ///< Not for methods whose failure map_multilevel() shares.
  /// A chart without a valid map gets one of low distortion, one that is no disk gets planar projections of its pieces,
  /// both with a note; or, when false, an exception.
  bool fall_back = true;
  /// What trace errors are divided by: the charts' area, or 1.
  bool error_per_area = true;
  TriplanarOptions projection;
  Deadline deadline;                              ///< Charts not begun by then are projected when fall_back.
  ChartMemory* memory = nullptr;                  ///< Charts that it has are not mapped again.
  const CornerAttribute<Vec2>* nearby = nullptr;  ///< Given: becomes ChartSurface::nearby.
  double energy_limit = std::numeric_limits<double>::infinity();  ///< Of the mean energy of a map that memory has.
  std::vector<MethodChoice>* choices = nullptr;  ///< Filled per chart when given; its size is that of the chart set.
};

/// With what the options of most methods have in common.
template <class Options>
DriverOptions driver_options(std::string_view function, const Options& options) {
  DriverOptions driver;
  driver.function = function;
  driver.up = options.up;
  driver.fall_back = options.fall_back;
  driver.projection = options.projection;
  driver.deadline = options.deadline;
  driver.memory = options.memory;
  if constexpr (requires { options.nearby; }) driver.nearby = options.nearby;
  if constexpr (requires { options.energy_limit; }) driver.energy_limit = options.energy_limit;
  return driver;
}

/// One for every chart that has a choice, in order.
std::vector<ChartChoice> choices_of_charts(std::vector<MethodChoice> choices);

/// Maps every chart on its own, in parallel, and puts the maps together. The trace is the sum over the charts as if
/// they had run at the same time.
/// @throws InvalidInput, SolverFailure as Flattening's producers say.
Flattening flatten_charts(const TriangleMesh& mesh, const ChartSet& charts, const ChartMethod& method,
                          const DriverOptions& options);

}  // namespace papilla::param_detail
