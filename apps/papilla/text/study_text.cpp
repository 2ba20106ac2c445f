// SPDX-License-Identifier: GPL-3.0-or-later
#include "text/study_text.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "shown_format.hpp"

namespace papilla::app {
namespace {

constexpr double k_minutes_before_boredom = 45;  // Schulze 2005, 8.2.

std::string end_text(const std::optional<double>& end) { return end ? shown_format("{:.3g}", *end) : "…"; }

bool is_open(const Estimate& estimate) { return !estimate.low && !estimate.high; }

std::string threshold_line(const StudyThreshold& threshold) {
  const PsychometricFit& fit = threshold.fit;
  std::string line = shown_format("  {:<12} {:<18} ", threshold.experiment, threshold.condition);
  if (is_open(threshold.threshold)) return line + "not determined by the levels and answers\n";
  line += shown_format("{} {}", estimate_text(threshold.threshold), std::string(difference_unit(threshold.factor)));
  line += shown_format("; slope {}, lapses {:.1f} %", estimate_text(threshold.slope), 100 * fit.function.lapse);
  if (fit.degrees >= 1)
    line += shown_format("; deviance {:.3g} on {}, p {:.2g}", fit.deviance, fit.degrees, fit.deviance_p);
  return line + (threshold.threshold.is_bounded() ? "\n" : "; the levels do not determine it\n");
}

std::string effect_line(const StudyEffect& effect) {
  const std::string against = effect.reference.empty() ? "" : " against " + effect.reference;
  return shown_format("    {:<10} {:<34} {}{}\n", effect.factor, effect.level + against, estimate_text(effect.effect),
                      effect.is_determined ? "" : "; no finite value fits best");
}

}  // namespace

std::string estimate_text(const Estimate& estimate) {
  return shown_format("{:.3g} ({} to {})", estimate.value, end_text(estimate.low), end_text(estimate.high));
}

std::string threshold_text(const Estimate& threshold) {
  if (is_open(threshold)) return "not determined";
  return estimate_text(threshold) + (threshold.is_bounded() ? "" : ", not determined");
}

std::string study_design_text(const std::string& file, const Study& study) {
  double seconds = 0;
  for (std::size_t p = 1; p <= study.participants.size(); ++p) seconds = std::max(seconds, session_seconds(study, p));
  const double minutes = seconds / 60;
  std::string text = shown_format("{}: {} stimuli, {} participants, {} trials each, about {:.0f} min\n", file,
                                  study.stimuli.size(), study.participants.size(), study.order_of(1).size(), minutes);
  std::map<std::size_t, std::size_t> trials;
  for (const std::size_t trial : study.order_of(1)) ++trials[study.trials[trial].experiment];
  for (const auto& [experiment, count] : trials)
    text += shown_format("  {:<16} {:>4} {}\n", study.experiments[experiment].id, count,
                         std::string(to_string(study.experiments[experiment].kind)));
  if (minutes > k_minutes_before_boredom)
    text += shown_format("  beyond {:.0f} min people tire: --experiments and --repetitions make it shorter\n",
                         k_minutes_before_boredom);
  for (const StudyStimulus& stimulus : study.stimuli)
    if (stimulus.limited_share > 0)
      text += shown_format("  {}: {:.2g} % of the relief were too steep for a probe and are gentler\n",
                           stimulus.label(), 100 * stimulus.limited_share);
  return text;
}

std::string study_analysis_text(const StudyAnalysis& analysis, double confidence) {
  std::string text = shown_format("{} participants, {} of {} trials; intervals of {:g} %\n", analysis.participants,
                                  analysis.answers, analysis.trials, 100 * confidence);
  if (!analysis.thresholds.empty()) text += "thresholds, three of four choices right\n";
  for (const StudyThreshold& threshold : analysis.thresholds) text += threshold_line(threshold);
  for (const StudyRegression& regression : analysis.regressions) {
    text += shown_format("{}: effects on {}, {} answers\n", regression.experiment,
                         regression.is_logistic ? "right answers, log odds" : "ratings, steps of the scale",
                         regression.answers);
    if (!regression.problem.empty()) text += shown_format("    none: {}\n", regression.problem);
    for (const StudyEffect& effect : regression.effects) text += effect_line(effect);
  }
  for (const StudyRecognition& r : analysis.recognitions)
    text += shown_format("grains on {:g} mm, {} answers: right {}, shape {}, coarse or fine {}\n", r.size_mm, r.answers,
                         estimate_text(r.right), estimate_text(r.shape), estimate_text(r.fineness));
  return text;
}

std::string study_power_text(const std::vector<StudyPower>& powers, double confidence) {
  std::string text;
  for (const StudyPower& power : powers)
    text += shown_format(
        "{:<12} {:<18} truth {:.3g}, median {:.3g}; within the {:g} % interval in {} of {} runs; {} intervals closed, "
        "high/low {:.3g}\n",
        power.experiment, power.condition, power.truth, power.median, 100 * confidence, power.covered, power.runs,
        power.determined, power.median_ratio);
  return text.empty() ? "the study has no choices: there is no threshold to find\n" : text;
}

}  // namespace papilla::app
