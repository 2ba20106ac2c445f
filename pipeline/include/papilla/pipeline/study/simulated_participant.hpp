// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/pipeline/study/study.hpp"
#include "papilla/pipeline/study/study_analysis.hpp"
#include "papilla/pipeline/study/study_answers.hpp"

namespace papilla {

/// What a simulated participant can tell and says. Ratings are rounded to the scale:
///     roughness       low + (high − low)·(D − D_least)/(D_most − D_least) + noise·(high − low)·z
///     recognisability high − 1 − (log2 height − 1)² + noise·(high − low)·z
/// with z of the standard normal distribution; grains are named with right shape and right fineness by chance.
struct SimulatedParticipant {
  PsychometricShape shape = PsychometricShape::logistic;
  double dimension_threshold = 0.25, height_threshold = 0.5;  ///< α of choices, in the unit of the difference.
  double spread = 0.4, lapse = 0.02;                          ///< β and λ of choices.
  double between = 0;                                         ///< Standard deviation of ln α among participants.
  double rating_noise = 0.15;
  double right_shape = 0.55, right_fineness = 0.75;  ///< Shares; the rest is guessed.
};

/// Answers of one participant to all trials of the order. Deterministic: the same seed, study
/// and participant give the same answers.
std::vector<StudyAnswer> simulate_answers(const Study& study, std::size_t participant,
                                          const SimulatedParticipant& truth, std::uint64_t seed);

/// How well a study finds a threshold that is known.
struct StudyPower {
  std::string experiment, condition;
  double truth = 0;           ///< The threshold simulated: the median one of participants.
  int runs = 0, covered = 0;  ///< Covered: the interval holds the truth. An open interval that does counts.
  int determined = 0;         ///< Runs with an interval of two ends.
  double median = 0;          ///< Of the estimates.
  double median_ratio = 0;    ///< Of high over low, of the determined intervals; 0 when there are none.
};

/// Simulates the study `runs` times with seeds from `seed` on, and analyses each by analyse_study(), without tests of
/// fit. Runs go in parallel; the result does not depend on the number of threads. Cost: that of analyse_study() a run.
/// @pre 1 <= participants <= study.participants.size().
std::vector<StudyPower> simulate_power(const Study& study, std::size_t participants, const SimulatedParticipant& truth,
                                       int runs, std::uint64_t seed, const StudyAnalysisOptions& options = {},
                                       const ProgressCallback& progress = {});

}  // namespace papilla
