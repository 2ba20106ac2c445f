// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <optional>

#include "papilla/pipeline/pictures/plot.hpp"
#include "study/analysis_page.hpp"

namespace papilla::app {
namespace {

using Style = PlotSeries::Style;

/// Data as points, the function as a line, and the interval of the threshold as a line at its height.
void add_curve(const StudyThreshold& threshold, int look, Plot& plot) {
  PlotSeries data{threshold.condition, {}, Style::points, look}, curve{"", {}, Style::line, look},
      interval{"", {}, Style::line, look};
  double low = threshold.levels.front().difference, high = threshold.levels.back().difference;
  for (const ChoiceLevel& level : threshold.levels)
    data.points.push_back({level.difference, static_cast<double>(level.correct) / level.trials});
  constexpr int k_steps = 80;
  for (int i = 0; i <= k_steps; ++i) {
    const double x = low * std::pow(high / low, static_cast<double>(i) / k_steps);
    curve.points.push_back({x, threshold.fit.function(x)});
  }
  const double at = threshold.fit.function(threshold.threshold.value);
  if (threshold.threshold.is_bounded())
    for (const double x : {*threshold.threshold.low, *threshold.threshold.high})
      interval.points.push_back({std::clamp(x, low, high), at});
  for (PlotSeries* series : {&data, &curve, &interval}) plot.series.push_back(std::move(*series));
}

std::optional<Plot> curves_of(const StudyExperiment& experiment, const StudyAnalysis& analysis) {
  Plot plot{.title = experiment.id + ": share of right choices",
            .x_name = "difference " + std::string(difference_unit(experiment.factor)),
            .y_name = "share right",
            .log_x = true};
  int look = 0;
  for (const StudyThreshold& threshold : analysis.thresholds)
    if (threshold.experiment == experiment.id) add_curve(threshold, look++, plot);
  if (look == 0) return std::nullopt;
  plot.low.y = 0.4;
  plot.high.y = 1.02;
  return plot;
}

/// Effects side by side as level strokes, with their intervals upright.
std::optional<Plot> effects_of(const StudyRegression& regression) {
  if (regression.effects.empty()) return std::nullopt;
  Plot plot{.title = regression.experiment + ": effects",
            .y_name = regression.is_logistic ? "log odds of a right answer" : "steps of the scale"};
  constexpr double k_half_stroke = 0.15;
  std::vector<PlotSeries> strokes, intervals;
  for (std::size_t i = 0; i < regression.effects.size(); ++i) {
    const StudyEffect& effect = regression.effects[i];
    const double x = static_cast<double>(i);
    plot.x_labels.push_back(effect.factor + " " + effect.level);
    if (!effect.is_determined) continue;
    const double value = effect.effect.value;
    strokes.push_back(
        {strokes.empty() ? "effect" : "", {{x - k_half_stroke, value}, {x + k_half_stroke, value}}, Style::line, 1});
    if (effect.effect.is_bounded())
      intervals.push_back(
          {intervals.empty() ? "interval" : "", {{x, *effect.effect.low}, {x, *effect.effect.high}}, Style::line, 0});
  }
  const double last = static_cast<double>(regression.effects.size()) - 1;
  plot.series.push_back({"none", {{-0.5, 0}, {last + 0.5, 0}}, Style::line, 7});
  for (auto* list : {&intervals, &strokes})
    for (PlotSeries& series : *list) plot.series.push_back(std::move(series));
  return plot;
}

std::optional<Plot> means_of(const StudyExperiment& experiment, const StudyAnalysis& analysis) {
  Plot plot{.title = experiment.id + ": mean rating", .y_name = "steps of the scale"};
  PlotSeries bars{"mean", {}, Style::bars, 4};
  for (const StudyRating& rating : analysis.ratings) {
    if (rating.experiment != experiment.id) continue;
    bars.points.push_back({static_cast<double>(plot.x_labels.size()), rating.mean});
    plot.x_labels.push_back(rating.stimulus);
  }
  if (bars.points.empty()) return std::nullopt;
  plot.low.y = experiment.low - 1;
  plot.high.y = experiment.high;
  plot.width_px = 1200;
  plot.series.push_back(std::move(bars));
  return plot;
}

}  // namespace

std::vector<StudyPicture> study_pictures(const Study& study, const StudyAnalysis& analysis) {
  std::vector<StudyPicture> pictures;
  const auto add = [&](const std::string& name, const std::optional<Plot>& plot) {
    if (!plot) return;
    if (auto svg = plot_svg(*plot)) pictures.push_back({name, std::move(*svg)});
  };
  for (const StudyExperiment& experiment : study.experiments) {
    add(experiment.id + "-psychometric", curves_of(experiment, analysis));
    add(experiment.id + "-ratings", means_of(experiment, analysis));
    for (const StudyRegression& regression : analysis.regressions)
      if (regression.experiment == experiment.id) add(experiment.id + "-effects", effects_of(regression));
  }
  return pictures;
}

}  // namespace papilla::app
