// SPDX-License-Identifier: MIT
#include "papilla/study/psychometric.hpp"

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "binomial_deviance.hpp"
#include "papilla/core/error.hpp"
#include "papilla/study/seeded_random.hpp"

namespace papilla {
namespace {

/// ln α, ln β, λ.
using Point = std::array<double, 3>;
constexpr std::size_t k_threshold = 0, k_spread = 1, k_lapse = 2;

/// The thresholds that are looked at lie this far beyond the levels, in ln x: a fiftieth to fifty times.
constexpr double k_beyond = 4;
constexpr double k_least_log_spread = -4.6, k_most_log_spread = 2.3;  // β from 0.01, a step, to 10, a plain.

struct Sigmoid {
  double value, slope;
};

Sigmoid sigmoid(PsychometricShape shape, double z) {
  if (shape == PsychometricShape::normal)
    return {0.5 * std::erfc(-z / std::numbers::sqrt2), std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi)};
  const double value = 1 / (1 + std::exp(-z));
  return {value, value * (1 - value)};
}

class Problem {
 public:
  Problem(const std::vector<ChoiceLevel>& levels, const PsychometricOptions& options)
      : levels_(levels), options_(options) {
    low_ = high_ = std::log(levels.front().difference);
    for (const ChoiceLevel& level : levels) {
      low_ = std::min(low_, std::log(level.difference));
      high_ = std::max(high_, std::log(level.difference));
    }
  }

  double least(std::size_t k) const {
    return k == k_threshold ? low_ - k_beyond : k == k_spread ? k_least_log_spread : 0;
  }
  double most(std::size_t k) const {
    return k == k_threshold ? high_ + k_beyond : k == k_spread ? k_most_log_spread : options_.most_lapse;
  }
  const std::vector<ChoiceLevel>& levels() const { return levels_; }
  const PsychometricOptions& options() const { return options_; }

  PsychometricFunction function(const Point& p) const {
    return {options_.shape, std::exp(p[k_threshold]), std::exp(p[k_spread]), options_.guess, p[k_lapse]};
  }

  double deviance(const Point& p) const {
    double sum = 0;
    const PsychometricFunction f = function(p);
    for (const ChoiceLevel& level : levels_) {
      const double root = study_detail::deviance_root(level.correct, level.trials, f(level.difference)).value;
      sum += root * root;
    }
    return sum;
  }

 private:
  const std::vector<ChoiceLevel>& levels_;
  const PsychometricOptions& options_;
  double low_ = 0, high_ = 0;
};

/// A residual a level; the parameters are blocks of their own, so that each can be held.
class DevianceCost : public ceres::CostFunction {
 public:
  explicit DevianceCost(const Problem& problem) : problem_(problem) {
    set_num_residuals(static_cast<int>(problem.levels().size()));
    *mutable_parameter_block_sizes() = {1, 1, 1};
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const double spread = std::exp(*parameters[k_spread]), lapse = *parameters[k_lapse];
    const double guess = problem_.options().guess, range = 1 - guess - lapse;
    for (std::size_t i = 0; i < problem_.levels().size(); ++i) {
      const ChoiceLevel& level = problem_.levels()[i];
      const double z = (std::log(level.difference) - *parameters[k_threshold]) / spread;
      const Sigmoid f = sigmoid(problem_.options().shape, z);
      const study_detail::DevianceRoot root =
          study_detail::deviance_root(level.correct, level.trials, guess + range * f.value);
      if (!std::isfinite(root.value) || !std::isfinite(root.by_probability)) return false;
      residuals[i] = root.value;
      if (jacobians == nullptr) continue;
      const Point slopes{-range * f.slope / spread, -range * f.slope * z, -f.value};
      for (std::size_t k = 0; k < slopes.size(); ++k)
        if (jacobians[k] != nullptr) jacobians[k][i] = root.by_probability * slopes[k];
    }
    return true;
  }

 private:
  const Problem& problem_;
};

class TraceOfIterations : public ceres::IterationCallback {
 public:
  explicit TraceOfIterations(Trace& trace) : trace_(trace) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    trace_.push_back({summary.cumulative_time_in_seconds, summary.cost});
    return ceres::SOLVER_CONTINUE;
  }

 private:
  Trace& trace_;
};

struct Descent {
  Point point{};
  double deviance = 0;
  StopReason stop = StopReason::direct;
};

/// Least deviance from `start`, with the parameters of `held` as they are.
Descent descend_with(const Problem& problem, Point start, const std::array<bool, 3>& held, Trace* trace) {
  ceres::Problem solved;
  for (std::size_t k = 0; k < start.size(); ++k) {
    start[k] = std::clamp(start[k], problem.least(k), problem.most(k));
    solved.AddParameterBlock(&start[k], 1);
    if (held[k]) {
      solved.SetParameterBlockConstant(&start[k]);
    } else {
      solved.SetParameterLowerBound(&start[k], 0, problem.least(k));
      solved.SetParameterUpperBound(&start[k], 0, problem.most(k));
    }
  }
  solved.AddResidualBlock(new DevianceCost(problem), nullptr, &start[0], &start[1], &start[2]);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  // Intervals are differences of deviances: far below the quantile of about 4.
  options.max_num_iterations = 100;
  options.function_tolerance = options.parameter_tolerance = options.gradient_tolerance = 1e-12;
  std::optional<TraceOfIterations> follower;
  if (trace != nullptr) options.callbacks.push_back(&follower.emplace(*trace));
  ceres::Solver::Summary summary;
  ceres::Solve(options, &solved, &summary);
  Descent end{start, 2 * summary.final_cost, StopReason::converged};
  if (!std::isfinite(end.deviance) || summary.termination_type == ceres::FAILURE)
    throw SolverFailure("fit_psychometric: the deviance is not finite");
  if (summary.termination_type == ceres::NO_CONVERGENCE) end.stop = StopReason::iteration_limit;
  return end;
}

/// Least deviance from `start`, with parameter `held` as it is. Most often lapses are none or as many as may be, where
/// a descent against the bound stalls: both are held, too, and the best of the three is taken.
Descent descend(const Problem& problem, const Point& start, std::optional<std::size_t> held, Trace* trace = nullptr) {
  const bool has_lapses = problem.most(k_lapse) > problem.least(k_lapse);
  std::array<bool, 3> fixed{held == k_threshold, held == k_spread, !has_lapses};
  Descent best = descend_with(problem, start, fixed, trace);
  if (!has_lapses) return best;
  fixed[k_lapse] = true;
  for (const double lapse : {problem.least(k_lapse), problem.most(k_lapse)}) {
    Point at_bound = best.point;
    at_bound[k_lapse] = lapse;
    Trace further;
    const Descent other = descend_with(problem, at_bound, fixed, trace != nullptr ? &further : nullptr);
    if (other.deviance >= best.deviance) continue;
    best = other;
    const double before = further.empty() ? 0 : trace->back().seconds;
    for (const TraceSample& sample : further) trace->push_back({before + sample.seconds, sample.error});
  }
  return best;
}

/// The best of a grid, with parameter `held` as it is in `at`.
Point scan(const Problem& problem, Point at, std::optional<std::size_t> held) {
  constexpr int k_thresholds = 33, k_spreads = 12, k_lapses = 2;
  const auto value = [&](std::size_t k, int i, int n) {
    return held == k ? at[k] : problem.least(k) + (i + 0.5) / n * (problem.most(k) - problem.least(k));
  };
  Point best = at;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < (held == k_threshold ? 1 : k_thresholds); ++i)
    for (int j = 0; j < (held == k_spread ? 1 : k_spreads); ++j)
      for (int k = 0; k < k_lapses; ++k) {
        const Point p{value(k_threshold, i, k_thresholds), value(k_spread, j, k_spreads), value(k_lapse, k, k_lapses)};
        const double deviance = problem.deviance(p);
        if (deviance < least) {
          least = deviance;
          best = p;
        }
      }
  return best;
}

Descent least_deviance(const Problem& problem, Trace* trace = nullptr) {
  return descend(problem, scan(problem, {}, {}), {}, trace);
}

/// Where the profile of parameter k leaves the deviances that are `more` above the least, on one side; nothing when it
/// stays within them up to the parameter's bound.
class Profile {
 public:
  Profile(const Problem& problem, const Descent& best, std::size_t k, double more)
      : problem_(problem), best_(best), k_(k), more_(more) {}

  std::optional<double> end(bool upwards) const {
    const double bound = upwards ? problem_.most(k_) : problem_.least(k_);
    Descent inner = best_;
    for (double step = 0.02; inner.point[k_] != bound; step *= 1.6) {
      const double value = inner.point[k_];
      const Descent outer = at(upwards ? std::min(bound, value + step) : std::max(bound, value - step), inner.point);
      if (excess(outer) > 0) return root(inner, outer);
      inner = outer;
    }
    return std::nullopt;
  }

 private:
  double excess(const Descent& there) const { return there.deviance - best_.deviance - more_; }

  /// The other parameters refitted, from the neighbour and from a scan.
  Descent at(double value, Point near) const {
    near[k_] = value;
    const Descent followed = descend(problem_, near, k_), anew = descend(problem_, scan(problem_, near, k_), k_);
    return anew.deviance < followed.deviance ? anew : followed;
  }

  double root(const Descent& inner, const Descent& outer) const {
    const auto f = [&](double value) {
      const double share = (value - inner.point[k_]) / (outer.point[k_] - inner.point[k_]);
      return excess(at(value, share < 0.5 ? inner.point : outer.point));
    };
    const auto& [low, high] = inner.point[k_] < outer.point[k_]
                                  ? std::pair<const Descent&, const Descent&>(inner, outer)
                                  : std::pair<const Descent&, const Descent&>(outer, inner);
    std::uintmax_t iterations = 60;
    const auto bracket = boost::math::tools::toms748_solve(f, low.point[k_], high.point[k_], excess(low), excess(high),
                                                           boost::math::tools::eps_tolerance<double>(20), iterations);
    return (bracket.first + bracket.second) / 2;
  }

  const Problem& problem_;
  const Descent& best_;
  std::size_t k_;
  double more_;
};

void check(const std::vector<ChoiceLevel>& levels, const PsychometricOptions& options) {
  if (levels.empty()) throw InvalidInput("fit_psychometric: levels is empty");
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const ChoiceLevel& level = levels[i];
    if (!(level.difference > 0) || !std::isfinite(level.difference))
      throw InvalidInput(fmt::format("fit_psychometric: levels[{}].difference {} is not above 0", i, level.difference));
    if (level.trials < 1 || level.correct < 0 || level.correct > level.trials)
      throw InvalidInput(
          fmt::format("fit_psychometric: levels[{}]: {} of {} trials correct", i, level.correct, level.trials));
  }
  if (!(options.guess >= 0 && options.most_lapse >= 0 && options.guess + options.most_lapse < 1))
    throw InvalidInput(fmt::format("fit_psychometric: guess {} and most_lapse {} leave nothing between", options.guess,
                                   options.most_lapse));
  if (!(options.confidence > 0 && options.confidence < 1))
    throw InvalidInput(fmt::format("fit_psychometric: confidence {} is not between 0 and 1", options.confidence));
}

double dispersion_of(const Problem& problem, const Descent& best, int degrees) {
  if (degrees < 1) return 1;
  const PsychometricFunction f = problem.function(best.point);
  double sum = 0;
  for (const ChoiceLevel& level : problem.levels()) {
    constexpr double k_least = 1e-9;  // Of a variance: shares that are certain scatter nothing.
    const double p = f(level.difference), excess = level.correct - level.trials * p;
    sum += excess * excess / std::max(k_least, level.trials * p * (1 - p));
  }
  return std::max(1.0, sum / degrees);
}

/// Share of data sets drawn from the fitted function whose deviance is that of the data or more [Wichmann and Hill
/// 2001, I].
double p_of_deviance(const Problem& problem, const Descent& best) {
  const PsychometricFunction f = problem.function(best.point);
  std::vector<ChoiceLevel> drawn = problem.levels();
  SeededRandom random(problem.options().seed);
  int as_bad = 0;
  for (int i = 0; i < problem.options().simulations; ++i) {
    for (ChoiceLevel& level : drawn) {
      level.correct = 0;
      for (int trial = 0; trial < level.trials; ++trial)
        level.correct += random.uniform() < f(level.difference) ? 1 : 0;
    }
    const Problem again(drawn, problem.options());
    if (descend(again, best.point, {}).deviance >= best.deviance) ++as_bad;
  }
  return (1.0 + as_bad) / (1.0 + problem.options().simulations);
}

}  // namespace

std::string_view to_string(PsychometricShape shape) noexcept {
  return shape == PsychometricShape::logistic ? "logistic" : "normal";
}

double PsychometricFunction::operator()(double difference) const {
  if (!(difference > 0)) return guess;
  return guess + (1 - guess - lapse) * sigmoid(shape, std::log(difference / threshold) / spread).value;
}

double PsychometricFunction::slope() const { return sigmoid(shape, 0).slope / spread; }

PsychometricFunction most_likely_function(const std::vector<ChoiceLevel>& levels, const PsychometricOptions& options) {
  check(levels, options);
  const Problem problem(levels, options);
  return problem.function(least_deviance(problem).point);
}

PsychometricFit fit_psychometric(const std::vector<ChoiceLevel>& levels, const PsychometricOptions& options) {
  check(levels, options);
  const Problem problem(levels, options);
  PsychometricFit fit;
  const Descent best = least_deviance(problem, &fit.trace);
  fit.function = problem.function(best.point);
  fit.stop = best.stop;
  fit.deviance = best.deviance;
  fit.degrees = static_cast<int>(levels.size()) - (options.most_lapse > 0 ? 3 : 2);

  fit.dispersion = dispersion_of(problem, best, fit.degrees);
  const double more = fit.dispersion * boost::math::quantile(boost::math::chi_squared(1), options.confidence);
  const Profile threshold(problem, best, k_threshold, more), spread(problem, best, k_spread, more);
  const auto exponential = [](const std::optional<double>& x) {
    return x ? std::optional(std::exp(*x)) : std::nullopt;
  };
  fit.threshold = {fit.function.threshold, exponential(threshold.end(false)), exponential(threshold.end(true))};
  // The wider the spread, the gentler the slope.
  const auto slope_of = [&](const std::optional<double>& log_spread) -> std::optional<double> {
    if (!log_spread) return std::nullopt;
    PsychometricFunction f = fit.function;
    f.spread = std::exp(*log_spread);
    return f.slope();
  };
  fit.slope = {fit.function.slope(), slope_of(spread.end(true)), slope_of(spread.end(false))};
  fit.is_determined = fit.threshold.is_bounded();
  if (options.simulations > 0 && fit.degrees >= 1) fit.deviance_p = p_of_deviance(problem, best);
  return fit;
}

}  // namespace papilla
