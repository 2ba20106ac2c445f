// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

namespace papilla {

/// A number with its confidence interval. An end that the data do not bound is empty.
struct Estimate {
  double value = 0;
  std::optional<double> low, high;

  bool is_bounded() const noexcept { return low.has_value() && high.has_value(); }
  bool covers(double truth) const noexcept { return !(low && truth < *low) && !(high && truth > *high); }
};

/// Quantile of Student's t with `degrees` of freedom. @pre 0 < share < 1, degrees >= 1.
double student_t_quantile(double share, double degrees);

/// Interval of an estimate from what it becomes when each of G clusters (participants) is left out once: the jackknife
/// (CR3),
///
///     s² = (G − 1)/G · Σ_g (θ_(−g) − θ)²,     θ ± t_{G−1}(1 − (1 − c)/2) · s
///
/// Of a mean over clusters of equal size it is Student's interval of their means. Without two clusters both ends are
/// empty. Cost: O(G).
/// @param without  θ_(−g). @param confidence c, in (0, 1).
/// Sources: J. G. MacKinnon, H. White, Some heteroskedasticity-consistent covariance matrix estimators, J. Econometrics
/// 29, 1985; J. G. MacKinnon, M. Ø. Nielsen, M. D. Webb, Cluster-robust inference: a guide, J. Econometrics 232, 2023.
Estimate jackknife_interval(double value, const std::vector<double>& without, double confidence = 0.95);

/// Share of `hits` in `trials` with Wilson's score interval [E. B. Wilson, Probable inference, JASA 22, 1927].
/// @pre 0 <= hits <= trials, trials >= 1.
Estimate wilson_interval(int hits, int trials, double confidence = 0.95);

}  // namespace papilla
