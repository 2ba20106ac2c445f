// SPDX-License-Identifier: MIT
#include "papilla/study/psychometric.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "papilla/core/error.hpp"
#include "papilla/study/seeded_random.hpp"

namespace papilla {
namespace {

constexpr double k_pi = std::numbers::pi;

std::vector<ChoiceLevel> drawn(const PsychometricFunction& truth, int trials, std::uint64_t seed) {
  SeededRandom random(seed);
  std::vector<ChoiceLevel> levels;
  for (int i = 1; i <= 8; ++i) {
    ChoiceLevel level{0.1 * i, trials, 0};
    for (int t = 0; t < trials; ++t) level.correct += random.uniform() < truth(level.difference) ? 1 : 0;
    levels.push_back(level);
  }
  return levels;
}

double log_likelihood(const std::vector<ChoiceLevel>& levels, const PsychometricFunction& f) {
  double sum = 0;
  for (const ChoiceLevel& level : levels) {
    const double p = f(level.difference);
    sum += level.correct * std::log(p) + (level.trials - level.correct) * std::log(1 - p);
  }
  return sum;
}

TEST(Psychometric, FunctionHasItsThresholdAndSlope) {
  for (const PsychometricShape shape : {PsychometricShape::logistic, PsychometricShape::normal}) {
    const PsychometricFunction f{shape, 0.3, 0.5, 0.5, 0};
    EXPECT_DOUBLE_EQ(f(0.3), 0.75);
    EXPECT_EQ(f(0), 0.5);
    EXPECT_NEAR(f(1e6), 1, 1e-9);
    constexpr double k_step = 1e-5;
    const double slope = 2 * (f(0.3 * std::exp(k_step)) - f(0.3 * std::exp(-k_step))) / (2 * k_step);
    EXPECT_NEAR(f.slope(), slope, 1e-8);
  }
  EXPECT_DOUBLE_EQ((PsychometricFunction{PsychometricShape::logistic, 1, 0.5, 0.5, 0}).slope(), 0.5);
  EXPECT_NEAR((PsychometricFunction{PsychometricShape::normal, 1, 1, 0.5, 0}).slope(), 1 / std::sqrt(2 * k_pi), 1e-12);
}

// Counts that are exactly the function's: two levels determine two parameters in closed form.
TEST(Psychometric, TwoLevelsGiveTheClosedForm) {
  // F = 2ψ − 1: 0.2 and 0.8, whose log odds are −ln 4 and ln 4.
  const std::vector<ChoiceLevel> levels = {{0.1, 1000, 600}, {0.4, 1000, 900}};
  const PsychometricFit fit = fit_psychometric(levels, {.most_lapse = 0, .simulations = 0});
  EXPECT_NEAR(fit.function.threshold, 0.2, 1e-6);
  EXPECT_NEAR(fit.function.spread, std::log(2.0) / std::log(4.0), 1e-6);
  EXPECT_NEAR(fit.deviance, 0, 1e-9);
  EXPECT_EQ(fit.degrees, 0);
  EXPECT_EQ(fit.deviance_p, 1);
  EXPECT_TRUE(fit.is_determined);
}

TEST(Psychometric, NoOtherFunctionIsMoreLikely) {
  const std::vector<ChoiceLevel> levels = drawn({PsychometricShape::logistic, 0.25, 0.4, 0.5, 0.02}, 30, 3);
  const PsychometricFit fit = fit_psychometric(levels, {.simulations = 0});
  const double best = log_likelihood(levels, fit.function);
  for (double a = std::log(0.05); a < std::log(2); a += 0.01)
    for (double s = std::log(0.05); s < std::log(5); s += 0.02)
      for (const double lapse : {0.0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06}) {
        const double other =
            log_likelihood(levels, {PsychometricShape::logistic, std::exp(a), std::exp(s), 0.5, lapse});
        if (!std::isfinite(other)) continue;
        ASSERT_LE(other, best + 1e-6) << a << " " << s << " " << lapse;
      }
}

/// Most likely log likelihood with a threshold that is held, by search.
double profile_at(const std::vector<ChoiceLevel>& levels, double threshold) {
  double best = -INFINITY;
  for (double s = std::log(0.05); s < std::log(5); s += 0.001)
    for (double lapse = 0; lapse <= 0.0601; lapse += 0.001) {
      const double other = log_likelihood(levels, {PsychometricShape::logistic, threshold, std::exp(s), 0.5, lapse});
      if (other > best) best = other;
    }
  return best;
}

TEST(Psychometric, IntervalEndsWhereTheProfileHasLostHalfTheQuantile) {
  const std::vector<ChoiceLevel> levels = drawn({PsychometricShape::logistic, 0.25, 0.4, 0.5, 0.02}, 30, 5);
  const PsychometricFit fit = fit_psychometric(levels, {.simulations = 0});
  ASSERT_TRUE(fit.is_determined);
  const double quantile = 3.841459 * fit.dispersion;  // χ²₁(0.95)
  const double best = log_likelihood(levels, fit.function);
  for (const double end : {*fit.threshold.low, *fit.threshold.high})
    EXPECT_NEAR(2 * (best - profile_at(levels, end)), quantile, 0.02) << end;
}

TEST(Psychometric, ShapesAgreeOnAThreshold) {
  const std::vector<ChoiceLevel> levels = drawn({PsychometricShape::normal, 0.25, 0.6, 0.5, 0}, 400, 9);
  const PsychometricFit logistic = fit_psychometric(levels, {.simulations = 0});
  const PsychometricFit normal = fit_psychometric(levels, {.shape = PsychometricShape::normal, .simulations = 0});
  EXPECT_NEAR(logistic.function.threshold, normal.function.threshold, 0.02);
  EXPECT_NEAR(normal.function.threshold, 0.25, 0.02);
  EXPECT_LE(normal.deviance, logistic.deviance + 2);
}

TEST(Psychometric, PerfectOrGuessedAnswersLeaveTheIntervalOpen) {
  std::vector<ChoiceLevel> perfect, guessed;
  for (int i = 1; i <= 8; ++i) {
    perfect.push_back({0.1 * i, 20, 20});
    guessed.push_back({0.1 * i, 20, 10});
  }
  const PsychometricFit sure = fit_psychometric(perfect, {.simulations = 20});
  EXPECT_FALSE(sure.threshold.low.has_value());
  ASSERT_TRUE(sure.threshold.high.has_value());
  EXPECT_LT(*sure.threshold.high, 0.2);
  EXPECT_FALSE(sure.is_determined);
  const PsychometricFit blind = fit_psychometric(guessed, {.simulations = 20});
  EXPECT_FALSE(blind.threshold.high.has_value());
  ASSERT_TRUE(blind.threshold.low.has_value());
  EXPECT_GT(*blind.threshold.low, 0.5);
  const PsychometricFit one = fit_psychometric({{0.2, 20, 15}});
  EXPECT_FALSE(one.threshold.is_bounded() && one.slope.is_bounded());
}

TEST(Psychometric, DevianceOfWhatFitsIsLikelyAndOfWhatDoesNotIsNot) {
  const std::vector<ChoiceLevel> good = drawn({PsychometricShape::logistic, 0.25, 0.4, 0.5, 0.02}, 40, 11);
  EXPECT_GT(fit_psychometric(good).deviance_p, 0.05);
  std::vector<ChoiceLevel> bad = good;
  bad[3].correct = 5;  // Of 40, far below chance, in the middle.
  const PsychometricFit fit = fit_psychometric(bad);
  EXPECT_DOUBLE_EQ(fit.deviance_p, 1.0 / 401);  // None of 400 drawn sets is as bad; the data count with them.
  EXPECT_EQ(fit.degrees, 5);
}

// Pearson's statistic of shares that a function can't follow, against the same sum written out.
TEST(Psychometric, ScatterBeyondThatOfChoicesWidensTheInterval) {
  std::vector<ChoiceLevel> levels = drawn({PsychometricShape::logistic, 0.25, 0.4, 0.5, 0.02}, 40, 11);
  const PsychometricFit even = fit_psychometric(levels, {.simulations = 0});
  for (std::size_t i = 0; i < levels.size(); ++i)
    levels[i].correct += i % 2 == 0 ? -6 : (levels[i].correct < 34 ? 6 : 0);
  const PsychometricFit uneven = fit_psychometric(levels, {.simulations = 0});
  double pearson = 0;
  for (const ChoiceLevel& level : levels) {
    const double p = uneven.function(level.difference);
    pearson += std::pow(level.correct - level.trials * p, 2) / (level.trials * p * (1 - p));
  }
  EXPECT_NEAR(uneven.dispersion, pearson / 5, 1e-9);
  EXPECT_GT(uneven.dispersion, 1.5);
  EXPECT_GE(even.dispersion, 1);
  EXPECT_EQ(fit_psychometric({{0.1, 1000, 600}, {0.4, 1000, 900}}, {.simulations = 0}).dispersion, 1);
}

TEST(Psychometric, IsDeterministicAndFollowed) {
  const std::vector<ChoiceLevel> levels = drawn({PsychometricShape::logistic, 0.25, 0.4, 0.5, 0.02}, 20, 1);
  const PsychometricFit a = fit_psychometric(levels), b = fit_psychometric(levels);
  EXPECT_EQ(a.threshold.low, b.threshold.low);
  EXPECT_EQ(a.deviance_p, b.deviance_p);
  ASSERT_FALSE(a.trace.empty());
  EXPECT_NEAR(2 * a.trace.back().error, a.deviance, 1e-6);
}

// Nominal 95 %. One participant, 8 levels of 20 trials, 100 fixed seeds; the share over 2000 seeds is in docs/study.md.
TEST(Psychometric, IntervalHoldsTheTruth) {
  for (const PsychometricShape shape : {PsychometricShape::logistic, PsychometricShape::normal}) {
    const PsychometricFunction truth{shape, 0.25, 0.4, 0.5, 0.02};
    int held = 0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed)
      held +=
          fit_psychometric(drawn(truth, 20, seed), {.shape = shape, .simulations = 0}).threshold.covers(truth.threshold)
              ? 1
              : 0;
    EXPECT_GE(held, 95) << to_string(shape);
    RecordProperty(std::string("held_") + std::string(to_string(shape)), held);
  }
}

TEST(Psychometric, RefusesWhatIsNoData) {
  EXPECT_THROW(fit_psychometric({}), InvalidInput);
  EXPECT_THROW(fit_psychometric({{0, 1, 1}}), InvalidInput);
  EXPECT_THROW(fit_psychometric({{NAN, 1, 1}}), InvalidInput);
  EXPECT_THROW(fit_psychometric({{0.1, 1, 2}}), InvalidInput);
  EXPECT_THROW(fit_psychometric({{0.1, 0, 0}}), InvalidInput);
  EXPECT_THROW(fit_psychometric({{0.1, 1, 1}}, {.guess = 0.99, .most_lapse = 0.05}), InvalidInput);
  EXPECT_THROW(fit_psychometric({{0.1, 1, 1}}, {.confidence = 1}), InvalidInput);
}

}  // namespace
}  // namespace papilla
