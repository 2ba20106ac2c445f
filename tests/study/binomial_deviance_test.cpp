// SPDX-License-Identifier: MIT
#include "binomial_deviance.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace papilla::study_detail {
namespace {

TEST(DevianceRoot, HalfItsSquareIsTheLossOfLogLikelihood) {
  for (const auto& [k, n, p] : {std::array{7.0, 10.0, 0.6}, {0.0, 4.0, 0.3}, {4.0, 4.0, 0.3}, {1.0, 50.0, 0.5}}) {
    const auto likelihood = [&](double q) {
      return (k > 0 ? k * std::log(q) : 0) + (n - k > 0 ? (n - k) * std::log(1 - q) : 0);
    };
    const double root = deviance_root(k, n, p).value;
    EXPECT_NEAR(root * root / 2, likelihood(k / n) - likelihood(p), 1e-12);
    EXPECT_EQ(root > 0, k > n * p);
  }
}

TEST(DevianceRoot, DerivativeIsThatOfFiniteDifferencesAlsoWhereHitsAreAsExpected) {
  constexpr double k_step = 1e-6;
  for (const auto& [k, n, p] :
       {std::array{7.0, 10.0, 0.6}, {7.0, 10.0, 0.7}, {7.0, 10.0, 0.7000001}, {0.0, 5.0, 0.2}}) {
    const double slope = (deviance_root(k, n, p + k_step).value - deviance_root(k, n, p - k_step).value) / (2 * k_step);
    EXPECT_NEAR(deviance_root(k, n, p).by_probability, slope, 1e-5 * std::abs(slope)) << k << " " << p;
  }
}

TEST(DevianceRoot, IsFiniteAtCertainty) {
  EXPECT_TRUE(std::isfinite(deviance_root(3, 5, 1).value));
  EXPECT_TRUE(std::isfinite(deviance_root(3, 5, 0).value));
  EXPECT_NEAR(deviance_root(5, 5, 1).value, 0, 1e-5);
}

}  // namespace
}  // namespace papilla::study_detail
