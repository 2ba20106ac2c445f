// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "papilla/core/trace.hpp"
#include "papilla/study/estimate.hpp"

namespace papilla {

/// Choices between two stimuli that differ by `difference`.
struct ChoiceLevel {
  double difference = 0;  ///< > 0, in any unit.
  int trials = 0, correct = 0;
};

/// The sigmoid F: 1/(1 + e^−z), or the cumulative Gaussian Φ(z).
enum class PsychometricShape { logistic, normal };

/// "logistic", "normal".
std::string_view to_string(PsychometricShape shape) noexcept;

/// Share of correct choices at a difference x > 0,
///
///     ψ(x) = γ + (1 − γ − λ) · F((ln x − ln α)/β)
///
/// α the threshold, where F = ½: with γ = ½ and λ = 0 that is 75 % correct. No difference is guessed: ψ(0) = γ.
struct PsychometricFunction {
  PsychometricShape shape = PsychometricShape::logistic;
  double threshold = 1;  ///< α, in the unit of the difference, > 0.
  double spread = 0.3;   ///< β, of ln x, > 0.
  double guess = 0.5;    ///< γ, in [0, 1).
  double lapse = 0;      ///< λ, in [0, 1 − γ).

  double operator()(double difference) const;
  /// dF/d ln x at the threshold: 1/(4β) or 1/(β·√(2π)).
  double slope() const;
};

struct PsychometricOptions {
  PsychometricShape shape = PsychometricShape::logistic;
  double guess = 0.5;
  double most_lapse = 0.06;  ///< λ is fitted from 0 to this; 0: none [Wichmann and Hill 2001].
  double confidence = 0.95;
  int simulations = 400;   ///< Of the deviance, for its p value; 0: none.
  std::uint64_t seed = 1;  ///< Of those.
};

struct PsychometricFit {
  PsychometricFunction function;  ///< Most likely.
  Estimate threshold, slope;      ///< Of `function`, with intervals by profile likelihood.
  /// Whether threshold and slope lie within what the levels can say. If not, an interval is open: all levels are too
  /// easy, or too hard, or there is one.
  bool is_determined = false;
  double deviance = 0;    ///< 2·Σ [k·ln(k/(nψ)) + (n − k)·ln((n − k)/(n(1 − ψ)))].
  int degrees = 0;        ///< Levels less the parameters fitted; no test of fit where it is below 1.
  double deviance_p = 1;  ///< Share of simulated data sets of `function` that fit as badly or worse.
  /// How much more the shares scatter than independent choices do: the mean of (k − nψ)²/(nψ(1 − ψ)) per degree of
  /// freedom, at least 1. People learn and tire.
  double dispersion = 1;
  StopReason stop = StopReason::direct;
  Trace trace;  ///< Half the deviance by iteration.
};

/// The most likely psychometric function, by non-linear least squares of the signed roots of the deviance from the best
/// point of a scan. The interval of a parameter holds the values that, with the others refitted, cost at most
/// dispersion · χ²₁(confidence) more deviance. Trials count as independent otherwise, so several participants need a
/// jackknife beside it (jackknife_interval()). Deterministic. Cost: about 10 ms, and 0.2 ms a simulation.
/// @throws InvalidInput when there is no level, a difference is not above 0, or counts do not fit; SolverFailure when a
/// value becomes infinite.
/// Sources: F. A. Wichmann, N. J. Hill, The psychometric function I and II, Perception & Psychophysics 63, 2001;
/// A. Meeker, L. Escobar, Teaching about approximate confidence regions based on maximum likelihood estimation, The
/// American Statistician 49, 1995; P. McCullagh, J. A. Nelder, Generalized Linear Models, 2nd ed. 1989, 4.5
/// (dispersion).
PsychometricFit fit_psychometric(const std::vector<ChoiceLevel>& levels, const PsychometricOptions& options = {});

/// The function alone, without intervals and test.
PsychometricFunction most_likely_function(const std::vector<ChoiceLevel>& levels,
                                          const PsychometricOptions& options = {});

}  // namespace papilla
