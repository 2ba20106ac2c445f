// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "evaluate/evaluation_files.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/pipeline/pictures/plot.hpp"

namespace papilla::app {
namespace {

using Style = PlotSeries::Style;

/// Where errors of 0 are drawn on a logarithmic axis: a decade below the smallest positive error of the group.
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

// Widths in pixels: of the plot area, of the margins without the legend, and of a letter.
constexpr int k_curves_px = 520, k_around_px = 200, k_letter_px = 7;

int longest(const std::vector<std::string>& names) {
  std::size_t most = 0;
  for (const std::string& name : names) most = std::max(most, name.size());
  return static_cast<int>(most);
}

/// Free space left of the curves for the longest name, as a share of their width.
double room_for(const std::vector<std::string>& names) {
  const double name = std::min(static_cast<double>(k_letter_px * longest(names)) / k_curves_px, 0.6);
  return name / (1 - name);
}

/// Labels every run on the front at its first sample there. The labels lie left of and below the front, where there are
/// no samples; the axes are extended so that the first one fits.
void label_front(const EvaluationGroup& group, double floor, Plot& plot) {
  constexpr double k_room_y = 0.15, k_line = 0.045;  // Of the range of the points.
  const double room_x = room_for(group.on_front);
  Bounds2 bounds;
  for (const PlotSeries& series : plot.series)
    for (const Vec2 p : series.points) bounds.add(p);
  if (group.front.empty() || bounds.is_empty()) return;
  const auto [low, high] = bounds;
  const double decades = std::max(std::log10(high.y / low.y), 0.3),
               decades_x = std::max(std::log10(high.x / low.x), 1.0);
  plot.low = {low.x * std::pow(10, -room_x * decades_x), low.y * std::pow(10, -k_room_y * decades)};
  plot.high = {1.2 * high.x, high.y * std::pow(10, 0.04 * decades)};
  std::vector<std::string> named;
  double last_y = INFINITY;
  for (const TraceSample& s : group.front)
    for (const EvaluationRun* run : group.runs) {
      if (!run->valid || !reaches_front(run->trace, {s})) continue;
      if (std::find(named.begin(), named.end(), run->name()) != named.end()) continue;
      named.push_back(run->name());
      last_y = std::min(std::max(s.error, floor), last_y * std::pow(10, -k_line * decades));
      plot.labels.push_back({run->name(), {std::max(s.seconds, 1e-9), last_y}});
    }
  plot.low.y = std::min(plot.low.y, last_y * std::pow(10, -2 * k_line * decades));
}

Plot curves_of(const EvaluationGroup& group) {
  Plot plot{.title = group.input, .x_name = "run time [s]", .y_name = group.error_name, .log_x = true, .log_y = true};
  plot.height_px = std::max(520, 120 + 17 * static_cast<int>(group.runs.size()));
  std::vector<std::string> names;
  for (const EvaluationRun* run : group.runs) names.push_back(legend_of(group, *run));
  plot.width_px = std::max(plot.width_px, k_curves_px + k_around_px + k_letter_px * longest(names));
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
  label_front(group, floor, plot);
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
