// SPDX-License-Identifier: MIT
#include "papilla/study/estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace papilla {
namespace {

TEST(Estimate, QuantilesOfStudentAreThoseOfTheTables) {
  EXPECT_NEAR(student_t_quantile(0.975, 1), 12.7062, 1e-4);
  EXPECT_NEAR(student_t_quantile(0.975, 9), 2.26216, 1e-5);
  EXPECT_NEAR(student_t_quantile(0.95, 30), 1.69726, 1e-5);
}

TEST(Estimate, JackknifeOfAMeanIsStudentsInterval) {
  const std::vector<double> x = {1.0, 2.5, 2.0, 4.5, 3.0};
  const double n = 5, mean = 13.0 / 5;
  double squares = 0;
  std::vector<double> without;
  for (const double value : x) {
    squares += (value - mean) * (value - mean);
    without.push_back((13.0 - value) / 4);
  }
  const double reach = student_t_quantile(0.975, n - 1) * std::sqrt(squares / (n - 1) / n);
  const Estimate estimate = jackknife_interval(mean, without);
  ASSERT_TRUE(estimate.is_bounded());
  EXPECT_NEAR(*estimate.low, mean - reach, 1e-12);
  EXPECT_NEAR(*estimate.high, mean + reach, 1e-12);
  EXPECT_FALSE(jackknife_interval(1, {1}).is_bounded());
}

// E. B. Wilson's interval of 8 in 10, as R's prop.test(8, 10, correct = FALSE) prints it.
TEST(Estimate, WilsonsIntervalIsThePublishedOne) {
  const Estimate share = wilson_interval(8, 10);
  EXPECT_NEAR(*share.low, 0.4901625, 1e-6);
  EXPECT_NEAR(*share.high, 0.9433178, 1e-6);
  EXPECT_EQ(*wilson_interval(0, 5).low, 0);
  EXPECT_NEAR(*wilson_interval(5, 5).high, 1, 1e-12);
}

TEST(Estimate, AnOpenEndCoversAll) {
  const Estimate open{1, 0.5, {}};
  EXPECT_TRUE(open.covers(1e9));
  EXPECT_FALSE(open.covers(0.4));
  EXPECT_FALSE(open.is_bounded());
}

}  // namespace
}  // namespace papilla
