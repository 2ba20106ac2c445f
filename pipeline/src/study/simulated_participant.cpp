// SPDX-License-Identifier: MIT
#include "papilla/pipeline/study/simulated_participant.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "papilla/study/seeded_random.hpp"

namespace papilla {
namespace {

/// Lowest and highest dimension of a study's stimuli.
std::pair<double, double> dimensions_of(const Study& study) {
  double low = 3, high = 2;
  for (const StudyStimulus& stimulus : study.stimuli)
    if (stimulus.dimension) low = std::min(low, *stimulus.dimension), high = std::max(high, *stimulus.dimension);
  return {low, high};
}

std::string rating_of(const Study& study, const StudyExperiment& experiment, const StudyStimulus& stimulus,
                      const SimulatedParticipant& truth, SeededRandom& random) {
  const double range = experiment.high - experiment.low;
  double felt = 0;
  if (stimulus.dimension) {
    const auto [low, high] = dimensions_of(study);
    felt = experiment.low + range * (high > low ? (*stimulus.dimension - low) / (high - low) : 0);
  } else {
    const double octaves = std::log2(stimulus.height);
    felt = experiment.high - 1 - (octaves - 1) * (octaves - 1);
  }
  felt += truth.rating_noise * range * random.normal();
  return std::to_string(
      static_cast<int>(std::lround(std::clamp(felt, double(experiment.low), double(experiment.high)))));
}

std::string recognised(const StudyExperiment& experiment, const StudyStimulus& stimulus,
                       const SimulatedParticipant& truth, SeededRandom& random) {
  const std::string& presented = stimulus.grain;
  const std::size_t split = presented.find_last_not_of("0123456789") + 1;
  const bool knows_shape = random.uniform() < truth.right_shape,
             knows_fineness = random.uniform() < truth.right_fineness;
  std::vector<std::string> possible;
  for (const std::string& label : experiment.labels)
    if ((!knows_shape || label.starts_with(presented.substr(0, split))) &&
        (!knows_fineness || label.ends_with(presented.substr(split))))
      possible.push_back(label);
  return possible.empty() ? experiment.labels[random.below(experiment.labels.size())]
                          : possible[random.below(possible.size())];
}

/// Whether an interval can be compared: a run's threshold of a condition.
const StudyThreshold* find(const StudyAnalysis& analysis, const StudyPower& power) {
  for (const StudyThreshold& threshold : analysis.thresholds)
    if (threshold.experiment == power.experiment && threshold.condition == power.condition) return &threshold;
  return nullptr;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::vector<StudyAnswer> simulate_answers(const Study& study, std::size_t participant,
                                          const SimulatedParticipant& truth, std::uint64_t seed) {
  SeededRandom random(seed, participant);
  const double own = std::exp(truth.between * random.normal());
  PsychometricFunction f{.shape = truth.shape, .spread = truth.spread, .guess = 0.5, .lapse = truth.lapse};
  std::vector<StudyAnswer> answers;
  const std::vector<std::size_t> order = study.order_of(participant);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const StudyTrial& trial = study.trials[order[i]];
    const StudyExperiment& experiment = study.experiments[trial.experiment];
    StudyAnswer answer{participant, i + 1, "", experiment.seconds, "simulated"};
    if (experiment.kind == StudyAnswerKind::choice) {
      f.threshold = own * (experiment.factor == "dimension" ? truth.dimension_threshold : truth.height_threshold);
      const std::string right = study.right_answer(trial);
      const bool is_right = random.uniform() < f(*study.difference_of(trial));
      answer.answer = is_right ? right : right == "first" ? "second" : "first";
    } else if (experiment.kind == StudyAnswerKind::rating) {
      answer.answer = rating_of(study, experiment, study.stimuli[trial.stimuli[0]], truth, random);
    } else {
      answer.answer = recognised(experiment, study.stimuli[trial.stimuli[0]], truth, random);
    }
    answers.push_back(std::move(answer));
  }
  return answers;
}

std::vector<StudyPower> simulate_power(const Study& study, std::size_t participants, const SimulatedParticipant& truth,
                                       int runs, std::uint64_t seed, const StudyAnalysisOptions& options,
                                       const ProgressCallback& progress) {
  StudyAnalysisOptions plain = options;
  plain.simulations = 0;
  plain.of_participants = false;
  std::vector<StudyAnalysis> analyses(static_cast<std::size_t>(runs));
  SharedProgress done(progress, "runs", runs);
  oneapi::tbb::parallel_for(0, runs, [&](int run) {
    std::vector<StudyAnswer> answers;
    for (std::size_t p = 1; p <= participants; ++p) {
      const std::vector<std::size_t> order = study.order_of(p);
      for (StudyAnswer& answer : simulate_answers(study, p, truth, seed + static_cast<std::uint64_t>(run))) {
        const StudyTrial& trial = study.trials[order[answer.place - 1]];
        if (study.experiments[trial.experiment].kind == StudyAnswerKind::choice) answers.push_back(std::move(answer));
      }
    }
    if (!answers.empty()) analyses[static_cast<std::size_t>(run)] = analyse_study(study, answers, plain);
    done.add(1);
  });

  std::vector<StudyPower> powers;
  for (const StudyThreshold& first : analyses.front().thresholds) {
    StudyPower power{.experiment = first.experiment, .condition = first.condition};
    power.truth = first.factor == "dimension" ? truth.dimension_threshold : truth.height_threshold;
    std::vector<double> estimates, ratios;
    for (const StudyAnalysis& analysis : analyses) {
      const StudyThreshold* const found = find(analysis, power);
      if (found == nullptr) continue;
      ++power.runs;
      estimates.push_back(found->threshold.value);
      if (found->threshold.covers(power.truth)) ++power.covered;
      if (!found->threshold.is_bounded()) continue;
      ++power.determined;
      ratios.push_back(*found->threshold.high / *found->threshold.low);
    }
    power.median = median(std::move(estimates));
    power.median_ratio = median(std::move(ratios));
    powers.push_back(std::move(power));
  }
  return powers;
}

}  // namespace papilla
