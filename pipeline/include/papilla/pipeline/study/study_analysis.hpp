// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/pipeline/study/study.hpp"
#include "papilla/pipeline/study/study_answers.hpp"
#include "papilla/study/estimate.hpp"
#include "papilla/study/psychometric.hpp"

namespace papilla {

struct StudyAnalysisOptions {
  PsychometricShape shape = PsychometricShape::logistic;
  double confidence = 0.95;
  int simulations = 400;        ///< Of each deviance; 0: none.
  std::uint64_t seed = 1;       ///< Of those.
  bool of_participants = true;  ///< A function for every participant, too.
};

/// The difference that one participant tells in three of four choices.
struct ParticipantThreshold {
  std::size_t participant = 0;
  int trials = 0;
  Estimate threshold;
  bool is_determined = false;
};

/// The difference that is told in three of four choices, under one condition.
struct StudyThreshold {
  std::string experiment, factor;   ///< "dimension" or "height".
  std::string condition;            ///< The force model of dimensions, the grain of heights.
  std::vector<ChoiceLevel> levels;  ///< Of all participants.
  PsychometricFit fit;              ///< Of all participants' choices as if they were one's.
  /// With several participants the interval holds that of `fit` and that of the jackknife over participants.
  Estimate threshold, slope;
  std::vector<ParticipantThreshold> participants;
};

/// What a factor does to answers, the others as they are.
struct StudyEffect {
  std::string factor;     ///< grain, height, model, dimension, difference, size, fineness.
  std::string level;      ///< "x2"; of a number what it is counted by, "per 0.1".
  std::string reference;  ///< The level that it is compared with; empty for numbers.
  Estimate effect;
  bool is_determined = true;
};

/// linear_regression() of ratings, in steps of the scale, or logistic_regression() of right answers, in log odds.
struct StudyRegression {
  std::string experiment;
  bool is_logistic = false;
  std::size_t answers = 0, participants = 0;
  std::vector<StudyEffect> effects;
  std::string problem;  ///< Why there are none.
};

/// Ratings of one stimulus.
struct StudyRating {
  std::string experiment, stimulus;
  std::vector<int> counts;  ///< Per step, from the lowest.
  int answers = 0;
  double mean = 0, deviation = 0;
};

/// Identification of grains of one size.
struct StudyRecognition {
  double size_mm = 0;
  int answers = 0;
  std::vector<std::string> labels;
  std::vector<std::vector<int>> counts;  ///< [presented][answered].
  Estimate right, shape, fineness;       ///< Shares of right grains, shapes, and coarse or fine; jackknife or Wilson.
};

struct StudyAnalysis {
  std::size_t participants = 0, answers = 0, trials = 0;  ///< With an answer; answered; of those participants in all.
  std::vector<StudyThreshold> thresholds;
  std::vector<StudyRegression> regressions;
  std::vector<StudyRating> ratings;
  std::vector<StudyRecognition> recognitions;
};

/// Thresholds of choices, effects of factors on ratings, choices and recognitions, and what ratings and recognitions
/// were. A session that is not finished counts with the answers that it has. Intervals are of each number by itself:
/// nothing is corrected for their number. Deterministic. Cost: about 0.1 s a condition, and 10 ms a participant.
/// @throws InvalidInput when there is no answer; SolverFailure as fit_psychometric().
StudyAnalysis analyse_study(const Study& study, const std::vector<StudyAnswer>& answers,
                            const StudyAnalysisOptions& options = {}, const ProgressCallback& progress = {});

}  // namespace papilla
