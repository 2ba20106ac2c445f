// SPDX-License-Identifier: MIT
#include "line_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace papilla::texture_detail {
namespace {

TEST(LineFit, StudentsQuantilesAreThoseOfTheTable) {
  EXPECT_NEAR(student_quantile(1), 12.706, 1e-3);
  EXPECT_NEAR(student_quantile(20), 2.086, 2e-3);
  EXPECT_NEAR(student_quantile(60), 2.000, 1e-3);
}

TEST(LineFit, SlopeAndIntervalOfFourPoints) {
  // 1 + 2 x with 0.1, -0.3, 0.3, -0.1, which neither their sum nor that over x shows.
  const LineFit fit = fit_line({0, 1, 2, 3}, {1.1, 2.7, 5.3, 6.9});
  EXPECT_NEAR(fit.slope, 2, 1e-12);
  EXPECT_NEAR(fit.intercept, 1, 1e-12);
  EXPECT_NEAR(fit.half_width, 4.303 * std::sqrt(0.2 / 2 / 5), 1e-3);
}

TEST(LineFit, AWeightIsThatManyEqualPoints) {
  const LineFit weighted = fit_line({0, 1, 2, 4}, {1, 2.5, 3, 8}, {1, 3, 2, 1}),
                repeated = fit_line({0, 1, 1, 1, 2, 2, 4}, {1, 2.5, 2.5, 2.5, 3, 3, 8});
  EXPECT_NEAR(weighted.slope, repeated.slope, 1e-12);
  EXPECT_NEAR(weighted.intercept, repeated.intercept, 1e-12);
}

/// The jackknife of a mean is that mean's standard error: of 1, 2, 3, 6, 8 without one each.
TEST(LineFit, TheJackknifeOfAMeanIsItsOwnInterval) {
  const std::vector<double> values{1, 2, 3, 6, 8};
  std::vector<double> without;
  for (const double v : values) without.push_back((20 - v) / 4);
  EXPECT_NEAR(jackknife_half_width(without), mean_interval(values).half_width, 1e-12);
  EXPECT_NEAR(mean_interval(values).half_width, 2.776 * std::sqrt(34.0 / 4 / 5), 2e-3);
}

TEST(LineFit, AnIntervalOfADimensionEndsWhereDimensionsDo) {
  FractalEstimate estimate{2.9, 0.1};
  set_interval(estimate, 0.3);
  EXPECT_DOUBLE_EQ(estimate.low, 2.6);
  EXPECT_DOUBLE_EQ(estimate.high, 3);
  estimate.dimension = 2.1;
  set_interval(estimate, 0.3);
  EXPECT_DOUBLE_EQ(estimate.low, 2);
  EXPECT_DOUBLE_EQ(estimate.high, 2.4);
}

TEST(LineFit, WhatIsNoDimensionKeepsItsInterval) {
  FractalEstimate estimate{1.8, 1.2};
  set_interval(estimate, 0.5);
  EXPECT_DOUBLE_EQ(estimate.low, 1.3);
  EXPECT_DOUBLE_EQ(estimate.high, 2.3);
}

}  // namespace
}  // namespace papilla::texture_detail
