// SPDX-License-Identifier: MIT
#pragma once

namespace papilla::study_detail {

/// The signed root of the deviance of k hits in n trials of probability p,
///
///     d = sign(k − np) · √(2·[k·ln(k/(np)) + (n − k)·ln((n − k)/(n(1 − p)))])
///
/// half the sum of whose squares is the negative logarithm of the likelihood, up to a constant; with its derivative.
struct DevianceRoot {
  double value = 0, by_probability = 0;
};

/// p is kept within [1e-12, 1 − 1e-12]. @pre 0 <= k <= n, n > 0.
DevianceRoot deviance_root(double hits, double trials, double probability) noexcept;

}  // namespace papilla::study_detail
