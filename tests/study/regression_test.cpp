// SPDX-License-Identifier: MIT
#include "papilla/study/regression.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "papilla/core/error.hpp"
#include "papilla/study/seeded_random.hpp"

namespace papilla {
namespace {

TEST(LinearRegression, OfOneParticipantIsTheTextbooksLine) {
  // y = 1, 3, 2, 5 at x = 1, 2, 3, 4: b = 1.1, residual variance 1.35, standard error √(1.35/5).
  const Regression r = linear_regression({1, {1, 2, 3, 4}, {1, 3, 2, 5}, {7, 7, 7, 7}});
  EXPECT_NEAR(r.coefficients[0].value, 1.1, 1e-12);
  EXPECT_NEAR(r.residual, std::sqrt(1.35), 1e-12);
  const double reach = student_t_quantile(0.975, 2) * std::sqrt(1.35 / 5);
  EXPECT_NEAR(*r.coefficients[0].high, 1.1 + reach, 1e-9);
  EXPECT_NEAR(*r.coefficients[0].low, 1.1 - reach, 1e-9);
}

// Everyone rates both levels once: the effect is the mean difference, its interval Student's of the differences.
TEST(LinearRegression, OfPairsIsTheTTest) {
  const std::vector<double> first = {1, 4, 2, 6}, second = {3, 5, 5, 8};
  RegressionData data{1, {}, {}, {}};
  double mean = 0, squares = 0;
  for (std::size_t p = 0; p < 4; ++p) {
    for (const double level : {0.0, 1.0}) {
      data.predictors.push_back(level);
      data.answers.push_back(level == 0 ? first[p] : second[p]);
      data.clusters.push_back(p);
    }
    mean += (second[p] - first[p]) / 4;
  }
  for (std::size_t p = 0; p < 4; ++p) squares += std::pow(second[p] - first[p] - mean, 2);
  const double reach = student_t_quantile(0.975, 3) * std::sqrt(squares / 3 / 4);
  const Regression r = linear_regression(data);
  EXPECT_EQ(r.clusters, 4U);
  EXPECT_NEAR(r.residual, std::sqrt(squares / 2 / 3), 1e-12);  // 8 answers less 4 constants and an effect.
  EXPECT_NEAR(r.coefficients[0].value, mean, 1e-12);
  EXPECT_NEAR(*r.coefficients[0].low, mean - reach, 1e-9);
  EXPECT_NEAR(*r.coefficients[0].high, mean + reach, 1e-9);
}

TEST(LinearRegression, ParticipantsConstantsDoNotMatter) {
  RegressionData data{2, {}, {}, {}}, moved;
  SeededRandom random(4);
  for (std::size_t p = 0; p < 5; ++p)
    for (int i = 0; i < 6; ++i) {
      const double a = random.normal(), b = random.normal();
      data.predictors.insert(data.predictors.end(), {a, b});
      data.answers.push_back(2 * a - b + 0.1 * random.normal());
      data.clusters.push_back(p);
    }
  moved = data;
  for (std::size_t i = 0; i < moved.answers.size(); ++i)
    moved.answers[i] += 10 * static_cast<double>(moved.clusters[i]);
  const Regression a = linear_regression(data), b = linear_regression(moved);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(a.coefficients[k].value, b.coefficients[k].value, 1e-10);
    EXPECT_NEAR(*a.coefficients[k].low, *b.coefficients[k].low, 1e-9);
  }
  EXPECT_NEAR(a.coefficients[0].value, 2, 0.1);
  EXPECT_NEAR(a.coefficients[1].value, -1, 0.1);
}

TEST(LinearRegression, IntervalHoldsTheTruthWithFewParticipantsThatDiffer) {
  int held = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SeededRandom random(seed);
    RegressionData data{1, {}, {}, {}};
    for (std::size_t p = 0; p < 6; ++p) {
      const double own = 1 + random.normal();
      for (int i = 0; i < 8; ++i) {
        data.predictors.push_back(i % 2);
        data.answers.push_back(own * (i % 2) + 0.3 * random.normal());
        data.clusters.push_back(p);
      }
    }
    held += linear_regression(data).coefficients[0].covers(1) ? 1 : 0;
  }
  EXPECT_NEAR(held, 190, 3 * std::sqrt(200 * 0.95 * 0.05));
}

TEST(LinearRegression, RefusesColumnsThatDoNotVaryByThemselves) {
  const auto message = [](const RegressionData& data) {
    try {
      linear_regression(data);
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message({2, {0.1, 0.2, 0.1, 0.4, 0.1, 0.6}, {1, 2, 3}, {1, 1, 1}}).find("column 0"), std::string::npos);
  EXPECT_NE(message({2, {1, 2, 2, 4, 3, 6}, {1, 2, 3}, {1, 1, 1}}).find("column 1"), std::string::npos);
  EXPECT_NE(message({1, {1, 2}, {1}, {1}}).find("do not fit"), std::string::npos);
  EXPECT_NE(message({1, {1, NAN}, {1, 2}, {1, 1}}).find("not finite"), std::string::npos);
}

// A table of two by two has its log odds ratio in closed form, with Woolf's standard error.
TEST(LogisticRegression, OfATableIsItsLogOddsRatio) {
  RegressionData data{1, {}, {}, {}};
  const auto add = [&](double x, int hits, int misses) {
    for (int i = 0; i < hits + misses; ++i) {
      data.predictors.push_back(x);
      data.answers.push_back(i < hits ? 1 : 0);
      data.clusters.push_back(0);
    }
  };
  add(0, 12, 28);
  add(1, 30, 10);
  const Regression r = logistic_regression(data);
  const double ratio = std::log(30.0 * 28 / (10.0 * 12));
  const double reach = 1.959964 * std::sqrt(1.0 / 12 + 1.0 / 28 + 1.0 / 30 + 1.0 / 10);
  EXPECT_NEAR(r.coefficients[0].value, ratio, 1e-4);
  EXPECT_NEAR(*r.coefficients[0].high, ratio + reach, 1e-3);
  EXPECT_NEAR(*r.coefficients[0].low, ratio - reach, 1e-3);
  EXPECT_TRUE(r.is_determined[0]);
}

// With a guess rate of ½ the shares 0.6 and 0.9 are F = 0.2 and 0.8.
TEST(LogisticRegression, TakesChanceAway) {
  RegressionData data{1, {}, {}, {}};
  for (const auto& [x, hits] : {std::array{0, 60}, {1, 90}})
    for (int i = 0; i < 100; ++i) {
      data.predictors.push_back(x);
      data.answers.push_back(i < hits ? 1 : 0);
      data.clusters.push_back(static_cast<std::size_t>(i % 5));
    }
  EXPECT_NEAR(logistic_regression(data, {.guess = 0.5}).coefficients[0].value, 2 * std::log(4.0), 1e-3);
}

// Of one participant at two levels: log odds of F = (p - γ)/(1 - γ - λ), whose variance is that of p over the square of
// dp/d(log odds) = (1 - γ - λ) F (1 - F).
TEST(LogisticRegression, KnowsWhatChanceAndLapsesLeaveUnknown) {
  const auto fit_of = [](int few, int many, const RegressionOptions& options) {
    RegressionData data{1, {}, {}, {}};
    for (const int hits : {few, many})
      for (int i = 0; i < 100; ++i) {
        data.predictors.push_back(hits == few ? 0 : 1);
        data.answers.push_back(i < hits ? 1 : 0);
        data.clusters.push_back(0);
      }
    return logistic_regression(data, options).coefficients[0];
  };
  const Estimate guessed = fit_of(60, 90, {.guess = 0.5});  // F = 0.2 and 0.8.
  const double reach = 1.959964 * std::sqrt((0.6 * 0.4 + 0.9 * 0.1) / 100) / (0.5 * 0.2 * 0.8);
  EXPECT_NEAR(guessed.value, 2 * std::log(4.0), 1e-3);
  EXPECT_NEAR(*guessed.high - guessed.value, reach, 1e-2);
  EXPECT_NEAR(guessed.value - *guessed.low, reach, 1e-2);
  EXPECT_NEAR(fit_of(58, 82, {.guess = 0.5, .lapse = 0.1}).value, 2 * std::log(4.0), 1e-3);
}

TEST(LogisticRegression, SaysWhereNoFiniteCoefficientFitsBest) {
  RegressionData data{1, {}, {}, {}};
  for (int i = 0; i < 20; ++i) {
    data.predictors.push_back(i < 10 ? 0 : 1);
    data.answers.push_back(i < 10 ? 0 : 1);
    data.clusters.push_back(static_cast<std::size_t>(i % 4));
  }
  const Regression r = logistic_regression(data);
  EXPECT_FALSE(r.is_determined[0]);
  EXPECT_FALSE(r.coefficients[0].is_bounded());
  EXPECT_TRUE(std::isfinite(r.coefficients[0].value));
}

TEST(LogisticRegression, RefusesAnswersThatAreNeitherRightNorWrong) {
  EXPECT_THROW(logistic_regression({1, {0, 1}, {0, 0.5}, {1, 1}}), InvalidInput);
  EXPECT_THROW(logistic_regression({1, {2, 2}, {0, 1}, {1, 1}}), InvalidInput);
}

}  // namespace
}  // namespace papilla
