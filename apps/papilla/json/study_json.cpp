// SPDX-License-Identifier: GPL-3.0-or-later
#include "json/study_json.hpp"

#include <algorithm>
#include <optional>

namespace papilla::app {
namespace {

Json end_json(const std::optional<double>& end) { return end ? Json(*end) : Json(); }

Json estimate_json(const Estimate& estimate) {
  return {{"value", estimate.value}, {"low", end_json(estimate.low)}, {"high", end_json(estimate.high)}};
}

void note(Json& levels, const Json& level) {
  if (std::find(levels.begin(), levels.end(), level) == levels.end()) levels.push_back(level);
}

Json levels_json(const std::vector<ChoiceLevel>& levels) {
  Json json = Json::array();
  for (const ChoiceLevel& level : levels)
    json.push_back({{"difference", level.difference}, {"trials", level.trials}, {"correct", level.correct}});
  return json;
}

Json trace_json(const Trace& trace) {
  Json json = Json::array();
  for (const TraceSample& sample : trace) json.push_back({{"seconds", sample.seconds}, {"error", sample.error}});
  return json;
}

Json threshold_json(const StudyThreshold& threshold) {
  Json participants = Json::array();
  for (const ParticipantThreshold& own : threshold.participants)
    participants.push_back({{"participant", own.participant},
                            {"trials", own.trials},
                            {"value", own.threshold.value},
                            {"low", end_json(own.threshold.low)},
                            {"high", end_json(own.threshold.high)},
                            {"determined", own.is_determined}});
  const PsychometricFit& fit = threshold.fit;
  return {
      {"experiment", threshold.experiment},
      {"factor", threshold.factor},
      {"condition", threshold.condition},
      {"unit", difference_unit(threshold.factor)},
      {"value", threshold.threshold.value},
      {"low", end_json(threshold.threshold.low)},
      {"high", end_json(threshold.threshold.high)},
      {"determined", threshold.threshold.is_bounded()},
      {"shape", to_string(fit.function.shape)},
      {"spread", fit.function.spread},
      {"slope", estimate_json(threshold.slope)},
      {"guess", fit.function.guess},
      {"lapse", fit.function.lapse},
      {"deviance",
       {{"value", fit.deviance}, {"degrees", fit.degrees}, {"p", fit.degrees >= 1 ? Json(fit.deviance_p) : Json()}}},
      {"stop", to_string(fit.stop)},
      {"trace", trace_json(fit.trace)},
      {"levels", levels_json(threshold.levels)},
      {"participants", std::move(participants)}};
}

Json recognition_json(const StudyRecognition& r) {
  return {{"size_mm", r.size_mm},
          {"answers", r.answers},
          {"labels", r.labels},
          {"counts", r.counts},
          {"right", estimate_json(r.right)},
          {"shape", estimate_json(r.shape)},
          {"fineness", estimate_json(r.fineness)}};
}

}  // namespace

Json study_design_json(const Study& study) {
  Json stimuli = Json::array(), trials = Json::array(), grains = Json::array(), heights = Json::array(),
       models = Json::array(), dimensions = Json::array();
  double seconds = 0;
  for (std::size_t p = 1; p <= study.participants.size(); ++p) seconds = std::max(seconds, session_seconds(study, p));
  for (const StudyStimulus& s : study.stimuli) {
    stimuli.push_back(
        {{"file", s.file}, {"label", s.label()}, {"depth_mm", s.depth_mm}, {"limited_share", s.limited_share}});
    note(grains, s.grain);
    note(heights, s.height);
    note(models, s.model);
    if (s.dimension) note(dimensions, *s.dimension);
  }
  for (const StudyTrial& trial : study.trials) {
    Json labels = Json::array();
    for (const std::size_t stimulus : trial.stimuli) labels.push_back(study.stimuli[stimulus].label());
    trials.push_back({{"experiment", study.experiments[trial.experiment].id}, {"stimuli", std::move(labels)}});
  }
  return {{"id", study.id},
          {"participants", study.participants.size()},
          {"trials_per_participant", study.order_of(1).size()},
          {"minutes", seconds / 60},
          {"stimuli", std::move(stimuli)},
          {"trials", std::move(trials)},
          {"factors",
           {{{"name", "grain"}, {"levels", grains}},
            {{"name", "height"}, {"levels", heights}},
            {{"name", "model"}, {"levels", models}},
            {{"name", "dimension"}, {"levels", dimensions}}}}};
}

Json study_analysis_json(const StudyAnalysis& analysis, double confidence) {
  Json json{{"participants", analysis.participants},
            {"answers", analysis.answers},
            {"trials", analysis.trials},
            {"confidence", confidence},
            {"thresholds", Json::array()},
            {"factors", Json::array()},
            {"regressions", Json::array()},
            {"ratings", Json::array()},
            {"recognitions", Json::array()}};
  for (const StudyThreshold& threshold : analysis.thresholds) json["thresholds"].push_back(threshold_json(threshold));
  for (const StudyRegression& regression : analysis.regressions) {
    json["regressions"].push_back({{"experiment", regression.experiment},
                                   {"kind", regression.is_logistic ? "logistic" : "linear"},
                                   {"answers", regression.answers},
                                   {"participants", regression.participants},
                                   {"problem", regression.problem.empty() ? Json() : Json(regression.problem)}});
    for (const StudyEffect& effect : regression.effects)
      json["factors"].push_back({{"experiment", regression.experiment},
                                 {"factor", effect.factor},
                                 {"level", effect.level},
                                 {"reference", effect.reference.empty() ? Json() : Json(effect.reference)},
                                 {"unit", regression.is_logistic ? "log odds" : "steps"},
                                 {"value", effect.effect.value},
                                 {"low", end_json(effect.effect.low)},
                                 {"high", end_json(effect.effect.high)},
                                 {"determined", effect.is_determined}});
  }
  for (const StudyRating& r : analysis.ratings)
    json["ratings"].push_back({{"experiment", r.experiment},
                               {"stimulus", r.stimulus},
                               {"answers", r.answers},
                               {"mean", r.mean},
                               {"deviation", r.deviation},
                               {"counts", r.counts}});
  for (const StudyRecognition& recognition : analysis.recognitions)
    json["recognitions"].push_back(recognition_json(recognition));
  return json;
}

Json study_power_json(const std::vector<StudyPower>& powers) {
  Json json = Json::array();
  for (const StudyPower& power : powers)
    json.push_back({{"experiment", power.experiment},
                    {"condition", power.condition},
                    {"truth", power.truth},
                    {"runs", power.runs},
                    {"covered", power.covered},
                    {"cover", power.runs > 0 ? static_cast<double>(power.covered) / power.runs : 0},
                    {"determined", power.determined},
                    {"median", power.median},
                    {"median_ratio", power.median_ratio}});
  return json;
}

}  // namespace papilla::app
