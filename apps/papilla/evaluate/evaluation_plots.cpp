// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "evaluate/evaluation_files.hpp"
#include "pictures/plot.hpp"

namespace papilla::app {
namespace {

using Style = PlotSeries::Style;

/// The smallest positive error of a group: where errors of 0 are drawn on a logarithmic axis, a decade lower.
double floor_of(const EvaluationGroup& group) {
  double least = std::numeric_limits<double>::infinity();
  for (const EvaluationRun* run : group.runs)
    for (const TraceSample& s : run->trace)
      if (s.error > 0) least = std::min(least, s.error);
  return std::isfinite(least) ? least / 10 : 1e-3;
}

std::vector<Vec2> points_of(const Trace& trace, double floor) {
  std::vector<Vec2> points;
  for (const TraceSample& s : trace) points.push_back({std::max(s.seconds, 1e-9), std::max(s.error, floor)});
  return points;
}

std::string legend_of(const EvaluationGroup& group, const EvaluationRun& run) {
  if (!run.valid) return run.name() + ", not valid";
  const bool on_front = std::find(group.on_front.begin(), group.on_front.end(), run.name()) != group.on_front.end();
  return on_front ? run.name() + " *" : run.name();
}

Plot curves_of(const EvaluationGroup& group) {
  Plot plot{.title = group.input, .x_name = "run time [s]", .y_name = group.error_name, .log_x = true, .log_y = true};
  plot.height_px = std::max(520, 120 + 17 * static_cast<int>(group.runs.size()));
  const double floor = floor_of(group);
  plot.series.push_back({"Pareto front *", points_of(group.front, floor), Style::band});
  for (std::size_t i = 0; i < group.runs.size(); ++i) {
    const EvaluationRun& run = *group.runs[i];
    plot.series.push_back(
        {legend_of(group, run), points_of(run.trace, floor), Style::line_and_points, static_cast<int>(i)});
    for (const Trace& repeat : run.repeats)
      if (run.repeats.size() > 1)
        plot.series.push_back({"", points_of(repeat, floor), Style::points, static_cast<int>(i)});
  }
  return plot;
}

Plot bars_of(const EvaluationGroup& group) {
  Plot plot{.title = group.input + ": where each one ends", .y_name = group.error_name, .log_y = true};
  plot.height_px = 640;
  PlotSeries bars{"", {}, Style::bars};
  const double floor = floor_of(group);
  for (const EvaluationRun* run : group.runs) {
    if (run->trace.empty()) continue;
    bars.points.push_back({static_cast<double>(plot.x_labels.size()), std::max(run->trace.back().error, floor)});
    plot.x_labels.push_back(legend_of(group, *run));
  }
  plot.series.push_back(std::move(bars));
  return plot;
}

Plot shares_of(const EvaluationGroup& group) {
  Plot plot{
      .title = group.input + ": how the error spreads over the surface", .y_name = "share of the area", .log_x = true};
  plot.height_px = std::max(520, 120 + 17 * static_cast<int>(group.runs.size()));
  for (std::size_t i = 0; i < group.runs.size(); ++i) {
    const ErrorShares& shares = group.runs[i]->shares;
    if (shares.shares.empty()) continue;
    plot.x_name = shares.error_name;
    PlotSeries series{legend_of(group, *group.runs[i]), {}, Style::steps, static_cast<int>(i)};
    for (std::size_t k = 0; k < shares.shares.size(); ++k)
      series.points.push_back({std::sqrt(shares.edges[k] * shares.edges[k + 1]), shares.shares[k]});
    plot.series.push_back(std::move(series));
  }
  return plot;
}

void add(std::vector<EvaluationPicture>& pictures, const Plot& plot) {
  if (auto svg = plot_svg(plot)) pictures.push_back({plot.title + ": " + plot.y_name, std::move(*svg)});
}

}  // namespace

std::vector<EvaluationPicture> runs_pictures(const std::vector<EvaluationGroup>& groups) {
  std::vector<EvaluationPicture> pictures;
  for (const EvaluationGroup& group : groups) {
    add(pictures, curves_of(group));
    if (group.runs.size() > 1) add(pictures, bars_of(group));
    add(pictures, shares_of(group));
  }
  return pictures;
}

}  // namespace papilla::app
