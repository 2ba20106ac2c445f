// SPDX-License-Identifier: MIT
#include "binomial_deviance.hpp"

#include <algorithm>
#include <cmath>

namespace papilla::study_detail {

DevianceRoot deviance_root(double hits, double trials, double probability) noexcept {
  constexpr double k_least = 1e-12;
  const double p = std::clamp(probability, k_least, 1 - k_least), misses = trials - hits;
  const double excess = hits - trials * p, variance = trials * p * (1 - p);
  // Where hits are as expected the root is (k − np)/σ, and its formula 0/0.
  if (std::abs(excess) < 1e-6 * std::sqrt(variance))
    return {excess / std::sqrt(variance), -trials / std::sqrt(variance)};
  double half = 0;
  if (hits > 0) half += hits * std::log(hits / (trials * p));
  if (misses > 0) half += misses * std::log(misses / (trials * (1 - p)));
  const double root = std::copysign(std::sqrt(2 * std::max(0.0, half)), excess);
  if (root == 0) return {0, -trials / std::sqrt(variance)};
  return {root, -excess / (p * (1 - p)) / root};
}

}  // namespace papilla::study_detail
