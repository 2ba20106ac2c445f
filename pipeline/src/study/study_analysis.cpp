// SPDX-License-Identifier: MIT
#include "papilla/pipeline/study/study_analysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "papilla/core/error.hpp"
#include "papilla/study/regression.hpp"

namespace papilla {
namespace {

/// Lapses of choices in a regression, where they are not fitted: the middle of what they are in practice [Wichmann and
/// Hill 2001].
constexpr double k_usual_lapse = 0.02;

/// An answer with what it is to.
struct Row {
  std::size_t participant;
  const StudyTrial* trial;
  const StudyStimulus *first, *second;  ///< Second: null, or of a choice the other one.
  std::string answer;
  bool is_right;
};

std::vector<Row> rows_of(const Study& study, std::size_t experiment, const std::vector<StudyAnswer>& answers) {
  std::map<std::size_t, std::vector<std::size_t>> orders;
  std::vector<Row> rows;
  for (const StudyAnswer& answer : answers) {
    auto [order, is_new] = orders.try_emplace(answer.participant);
    if (is_new) order->second = study.order_of(answer.participant);
    const StudyTrial& trial = study.trials[order->second[answer.place - 1]];
    if (trial.experiment != experiment) continue;
    rows.push_back({answer.participant, &trial, &study.stimuli[trial.stimuli[0]],
                    trial.stimuli.size() > 1 ? &study.stimuli[trial.stimuli[1]] : nullptr, answer.answer,
                    answer.answer == study.right_answer(trial)});
  }
  return rows;
}

std::vector<std::size_t> participants_of(const std::vector<Row>& rows) {
  std::set<std::size_t> names;
  for (const Row& row : rows) names.insert(row.participant);
  return {names.begin(), names.end()};
}

std::string condition_of(const StudyExperiment& experiment, const Row& row) {
  return experiment.factor == "dimension" ? row.first->model : row.first->grain;
}

// Thresholds ----------------------------------------------------------------------------------------------------------

using KeepRow = std::function<bool(const Row&)>;

std::vector<ChoiceLevel> levels_of(const Study& study, const std::vector<Row>& rows, const KeepRow& keep) {
  constexpr double k_same = 1e9;  // Differences of decimals have rounding: 2.3 − 2.1.
  std::map<double, ChoiceLevel> levels;
  for (const Row& row : rows) {
    if (!keep(row)) continue;
    const double difference = std::round(*study.difference_of(*row.trial) * k_same) / k_same;
    ChoiceLevel& level = levels[difference];
    level.difference = difference;
    ++level.trials;
    level.correct += row.is_right ? 1 : 0;
  }
  std::vector<ChoiceLevel> list;
  for (const auto& [difference, level] : levels) list.push_back(level);
  return list;
}

/// The wider one of two intervals of a value, at each end.
Estimate union_of(const Estimate& a, const Estimate& b) {
  Estimate wide{a.value, {}, {}};
  if (a.low && b.low) wide.low = std::min(*a.low, *b.low);
  if (a.high && b.high) wide.high = std::max(*a.high, *b.high);
  return wide;
}

/// jackknife_interval() of the logarithm of a positive value.
Estimate jackknife_of_positive(double value, std::vector<double> without, double confidence) {
  for (double& other : without) other = std::log(other);
  Estimate estimate = jackknife_interval(std::log(value), without, confidence);
  estimate.value = value;
  for (std::optional<double>* end : {&estimate.low, &estimate.high})
    if (*end) *end = std::exp(**end);
  return estimate;
}

/// Widens the intervals of choices that several people made.
void add_participants(const Study& study, const std::vector<Row>& rows, const PsychometricOptions& options,
                      StudyThreshold& threshold) {
  const std::vector<std::size_t> participants = participants_of(rows);
  if (participants.size() < 2) return;
  std::vector<double> thresholds, slopes;
  for (const std::size_t left_out : participants) {
    const PsychometricFunction f = most_likely_function(
        levels_of(study, rows, [&](const Row& row) { return row.participant != left_out; }), options);
    thresholds.push_back(f.threshold);
    slopes.push_back(f.slope());
  }
  const double confidence = options.confidence;
  threshold.threshold =
      union_of(threshold.threshold, jackknife_of_positive(threshold.threshold.value, thresholds, confidence));
  threshold.slope = union_of(threshold.slope, jackknife_of_positive(threshold.slope.value, slopes, confidence));
}

StudyThreshold threshold_of(const Study& study, const StudyExperiment& experiment, const std::string& condition,
                            const std::vector<Row>& rows, const StudyAnalysisOptions& options) {
  PsychometricOptions fit{.shape = options.shape,
                          .confidence = options.confidence,
                          .simulations = options.simulations,
                          .seed = options.seed};
  StudyThreshold threshold;
  threshold.experiment = experiment.id;
  threshold.factor = experiment.factor;
  threshold.condition = condition;
  threshold.levels = levels_of(study, rows, [](const Row&) { return true; });
  threshold.fit = fit_psychometric(threshold.levels, fit);
  threshold.threshold = threshold.fit.threshold;
  threshold.slope = threshold.fit.slope;
  fit.simulations = 0;
  add_participants(study, rows, fit, threshold);
  if (!options.of_participants) return threshold;
  for (const std::size_t participant : participants_of(rows)) {
    const std::vector<ChoiceLevel> levels =
        levels_of(study, rows, [&](const Row& row) { return row.participant == participant; });
    const PsychometricFit own = fit_psychometric(levels, fit);
    int trials = 0;
    for (const ChoiceLevel& level : levels) trials += level.trials;
    threshold.participants.push_back({participant, trials, own.threshold, own.is_determined});
  }
  return threshold;
}

void add_thresholds(const Study& study, const StudyExperiment& experiment, const std::vector<Row>& rows,
                    const StudyAnalysisOptions& options, StudyAnalysis& analysis) {
  std::vector<std::string> conditions;
  for (const Row& row : rows)
    if (const std::string name = condition_of(experiment, row);
        std::find(conditions.begin(), conditions.end(), name) == conditions.end())
      conditions.push_back(name);
  std::sort(conditions.begin(), conditions.end());
  for (const std::string& condition : conditions) {
    std::vector<Row> own;
    for (const Row& row : rows)
      if (condition_of(experiment, row) == condition) own.push_back(row);
    analysis.thresholds.push_back(threshold_of(study, experiment, condition, own, options));
  }
}

// Effects -------------------------------------------------------------------------------------------------------------

std::string shape_of(const std::string& grain) { return grain.substr(0, grain.find_last_not_of("0123456789") + 1); }
std::string fineness_of(const std::string& grain) { return grain.substr(shape_of(grain).size()); }

/// What an answer may depend on: a name, or a number.
struct Factor {
  std::string name;
  std::function<std::string(const Row&)> level;  ///< Of a factor with levels.
  std::function<double(const Row&)> number;      ///< Of one without, in the unit of `unit`.
  std::string unit;
};

std::vector<Factor> factors_of(const Study& study, const StudyExperiment& experiment) {
  const Factor grain{"grain", [](const Row& row) { return row.first->grain; }, {}, {}};
  const Factor model{"model", [](const Row& row) { return row.first->model; }, {}, {}};
  if (experiment.kind == StudyAnswerKind::choice)
    return {{"difference",
             {},
             [&study](const Row& row) { return std::log2(*study.difference_of(*row.trial)); },
             "per doubling"},
            grain,
            model};
  if (experiment.kind == StudyAnswerKind::identification)
    return {{"grain", [](const Row& row) { return shape_of(row.first->grain); }, {}, {}},
            {"fineness", [](const Row& row) { return fineness_of(row.first->grain); }, {}, {}},
            {"size", [](const Row& row) { return fmt::format("{} mm", row.first->size_mm); }, {}, {}}};
  constexpr double k_step = 0.1;
  return {grain,
          {"height", [](const Row& row) { return fmt::format("x{}", row.first->height); }, {}, {}},
          model,
          {"dimension", {}, [](const Row& row) { return row.first->dimension.value_or(2) / k_step; }, "per 0.1"}};
}

/// The columns of a regression, and what each of them is.
struct Design {
  RegressionData data;
  std::vector<StudyEffect> effects;
};

Design design_of(const std::vector<Factor>& factors, const std::vector<Row>& rows) {
  Design design;
  std::vector<std::function<double(const Row&)>> columns;
  for (const Factor& factor : factors) {
    if (factor.number) {
      std::set<double> values;
      for (const Row& row : rows) values.insert(factor.number(row));
      if (values.size() < 2) continue;
      design.effects.push_back({factor.name, factor.unit, "", {}, true});
      columns.push_back(factor.number);
      continue;
    }
    std::set<std::string> levels;
    for (const Row& row : rows) levels.insert(factor.level(row));
    // The reference: no change of height, the displaced surface; else the first by name.
    std::string reference = *levels.begin();
    for (const char* usual : {"x1", "heightfield", "spheres", "spheres6"})
      if (levels.contains(usual)) reference = usual;
    for (const std::string& level : levels) {
      if (level == reference) continue;
      design.effects.push_back({factor.name, level, reference, {}, true});
      columns.emplace_back([of = factor.level, level](const Row& row) { return of(row) == level ? 1.0 : 0.0; });
    }
  }
  design.data.columns = columns.size();
  for (const Row& row : rows) {
    for (const auto& column : columns) design.data.predictors.push_back(column(row));
    design.data.clusters.push_back(row.participant);
  }
  return design;
}

StudyRegression regression_of(const Study& study, const StudyExperiment& experiment, const std::vector<Row>& rows,
                              double confidence) {
  StudyRegression result;
  result.experiment = experiment.id;
  result.is_logistic = experiment.kind != StudyAnswerKind::rating;
  result.answers = rows.size();
  result.participants = participants_of(rows).size();
  Design design = design_of(factors_of(study, experiment), rows);
  if (design.data.columns == 0) {
    result.problem = "no factor varies in the answers";
    return result;
  }
  for (const Row& row : rows)
    design.data.answers.push_back(result.is_logistic ? (row.is_right ? 1.0 : 0.0) : std::stod(row.answer));
  RegressionOptions options{.confidence = confidence};
  if (experiment.kind == StudyAnswerKind::choice) {
    options.guess = 0.5;
    options.lapse = k_usual_lapse;
  } else if (experiment.kind == StudyAnswerKind::identification) {
    options.guess = 1 / static_cast<double>(experiment.labels.size());
  }
  try {
    const Regression fit =
        result.is_logistic ? logistic_regression(design.data, options) : linear_regression(design.data, options);
    for (std::size_t k = 0; k < design.effects.size(); ++k) {
      design.effects[k].effect = fit.coefficients[k];
      design.effects[k].is_determined = fit.is_determined[k];
    }
    result.effects = std::move(design.effects);
  } catch (const InvalidInput&) {
    // Of a few first answers.
    result.problem = "the answers do not tell the factors apart";
  }
  return result;
}

// What was said -------------------------------------------------------------------------------------------------------

void add_ratings(const StudyExperiment& experiment, const std::vector<Row>& rows, StudyAnalysis& analysis) {
  std::map<const StudyStimulus*, StudyRating> ratings;
  std::vector<const StudyStimulus*> order;
  for (const Row& row : rows) {
    auto [found, is_new] = ratings.try_emplace(row.first);
    StudyRating& rating = found->second;
    if (is_new) {
      order.push_back(row.first);
      rating.experiment = experiment.id;
      rating.stimulus = row.first->label();
      rating.counts.assign(static_cast<std::size_t>(experiment.high - experiment.low + 1), 0);
    }
    ++rating.counts[static_cast<std::size_t>(std::stoi(row.answer) - experiment.low)];
    ++rating.answers;
  }
  std::sort(order.begin(), order.end());  // As they stand in the study.
  for (const StudyStimulus* stimulus : order) {
    StudyRating& rating = ratings[stimulus];
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < rating.counts.size(); ++i) {
      const double value = experiment.low + static_cast<double>(i);
      sum += rating.counts[i] * value;
      squares += rating.counts[i] * value * value;
    }
    rating.mean = sum / rating.answers;
    if (rating.answers > 1)
      rating.deviation = std::sqrt(std::max(0.0, (squares - sum * rating.mean) / (rating.answers - 1)));
    analysis.ratings.push_back(std::move(rating));
  }
}

/// A share with its interval over participants, or over answers of one.
Estimate share_of(const std::vector<Row>& rows, const std::function<bool(const Row&)>& is_hit, double confidence) {
  std::map<std::size_t, std::pair<int, int>> counts;  // Hits and answers.
  int hits = 0;
  for (const Row& row : rows) {
    auto& [own_hits, own] = counts[row.participant];
    ++own;
    if (is_hit(row)) ++own_hits, ++hits;
  }
  const int all = static_cast<int>(rows.size());
  if (counts.size() < 2) return wilson_interval(hits, all, confidence);
  std::vector<double> without;
  for (const auto& [participant, own] : counts)
    without.push_back(static_cast<double>(hits - own.first) / (all - own.second));
  Estimate share = jackknife_interval(static_cast<double>(hits) / all, without, confidence);
  // Where all agree, their spread says nothing.
  const Estimate wilson = wilson_interval(hits, all, confidence);
  share = union_of(share, wilson);
  if (share.low) *share.low = std::max(0.0, *share.low);
  if (share.high) *share.high = std::min(1.0, *share.high);
  return share;
}

void add_recognitions(const StudyExperiment& experiment, const std::vector<Row>& rows, double confidence,
                      StudyAnalysis& analysis) {
  std::set<double, std::greater<>> sizes;
  for (const Row& row : rows) sizes.insert(row.first->size_mm);
  const auto index = [&](const std::string& label) {
    return static_cast<std::size_t>(std::find(experiment.labels.begin(), experiment.labels.end(), label) -
                                    experiment.labels.begin());
  };
  for (const double size_mm : sizes) {
    std::vector<Row> own;
    for (const Row& row : rows)
      if (row.first->size_mm == size_mm && index(row.first->grain) < experiment.labels.size()) own.push_back(row);
    if (own.empty()) continue;
    StudyRecognition recognition;
    recognition.size_mm = size_mm;
    recognition.answers = static_cast<int>(own.size());
    recognition.labels = experiment.labels;
    recognition.counts.assign(experiment.labels.size(), std::vector<int>(experiment.labels.size(), 0));
    for (const Row& row : own) ++recognition.counts[index(row.first->grain)][index(row.answer)];
    recognition.right = share_of(
        own, [](const Row& row) { return row.is_right; }, confidence);
    recognition.shape = share_of(
        own, [](const Row& row) { return shape_of(row.answer) == shape_of(row.first->grain); }, confidence);
    recognition.fineness = share_of(
        own, [](const Row& row) { return fineness_of(row.answer) == fineness_of(row.first->grain); }, confidence);
    analysis.recognitions.push_back(std::move(recognition));
  }
}

}  // namespace

StudyAnalysis analyse_study(const Study& study, const std::vector<StudyAnswer>& answers,
                            const StudyAnalysisOptions& options, const ProgressCallback& progress) {
  if (answers.empty()) throw InvalidInput("analyse_study: there is no answer");
  StudyAnalysis analysis;
  analysis.answers = answers.size();
  std::set<std::size_t> participants;
  for (const StudyAnswer& answer : answers) participants.insert(answer.participant);
  analysis.participants = participants.size();
  for (const std::size_t participant : participants) analysis.trials += study.order_of(participant).size();
  for (std::size_t e = 0; e < study.experiments.size(); ++e) {
    report_progress(progress, "analysis", static_cast<double>(e) / static_cast<double>(study.experiments.size()));
    const StudyExperiment& experiment = study.experiments[e];
    const std::vector<Row> rows = rows_of(study, e, answers);
    if (rows.empty()) continue;
    if (experiment.kind == StudyAnswerKind::choice) add_thresholds(study, experiment, rows, options, analysis);
    if (experiment.kind == StudyAnswerKind::rating) add_ratings(experiment, rows, analysis);
    if (experiment.kind == StudyAnswerKind::identification)
      add_recognitions(experiment, rows, options.confidence, analysis);
    analysis.regressions.push_back(regression_of(study, experiment, rows, options.confidence));
  }
  return analysis;
}

}  // namespace papilla
