// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "papilla/study/estimate.hpp"

namespace papilla {

/// Answers and what they may depend on.
struct RegressionData {
  std::size_t columns = 0;            ///< Of each row, without an intercept.
  std::vector<double> predictors;     ///< Row by row.
  std::vector<double> answers;        ///< Per row; of a logistic regression 0 or 1.
  std::vector<std::size_t> clusters;  ///< Per row: the participant.
};

struct RegressionOptions {
  double confidence = 0.95;
  double guess = 0;  ///< γ of a logistic regression: the share that is right by chance.
  double lapse = 0;  ///< λ of it: the share that is wrong whatever is presented.
};

struct Regression {
  std::vector<Estimate> coefficients;  ///< Per column.
  std::size_t rows = 0, clusters = 0;
  double residual = 0;              ///< Linear: standard deviation of what is left. Logistic: deviance.
  std::vector<bool> is_determined;  ///< Per column; false where no finite value fits best, and no interval is given.
};

/// Least squares of y = u_g + x·b with a constant u_g a participant, which is taken out by subtracting each
/// participant's means. Intervals by jackknife over participants (jackknife_interval()); of one participant those of
/// Student's t for independent errors. Deterministic. Cost: O(rows · columns² · participants).
/// @throws InvalidInput when sizes do not fit, a value is not finite, or the columns are collinear, naming the column.
Regression linear_regression(const RegressionData& data, const RegressionOptions& options = {});

/// Most likely b of P(y = 1) = γ + (1 − γ − λ)/(1 + e^−(a + x·b)), by non-linear least squares of the signed roots of
/// the deviance. Intervals by jackknife over participants; of one participant by Fisher's information. Coefficients
/// count log odds. A column that tells all right answers from all wrong ones has no finite b. Deterministic.
/// @throws as linear_regression(), and InvalidInput when an answer is neither 0 nor 1.
Regression logistic_regression(const RegressionData& data, const RegressionOptions& options = {});

}  // namespace papilla
