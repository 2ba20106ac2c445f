// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>

namespace papilla {

/// A graph of fractional Brownian motion in grey levels, 0 to 256, for the force models `graph-…`.
///
/// X_H(0) = 0 and E[(X_H(s) − X_H(t))²] = |s − t|^(2H) exactly and everywhere: increments with their covariances by
/// Hosking's recursion [Modeling persistence in hydrological time series using fractional differencing, 1984]. Then the
/// graph is shifted and stretched to the 256 grey levels. Its dimension is 2 − H, and H = 3 − D for a cut through a
/// surface of dimension D [Schulze 2005, theorems 6.1 and 6.2, section 6.4.2]. The midpoints of section 6.3.2 give the
/// same distribution for H = ½ only, and their printed variance 2^(−jH) is a standard deviation.
///
/// The random numbers are the same for every H, so that two graphs differ by H alone.
class GreyGraph {
 public:
  static constexpr int k_finest_level = 8;
  static constexpr int k_samples = (1 << k_finest_level) + 1;  ///< 257, as in the source.

  /// @param hurst H, limited to [0.02, 0.98]; ½ where it is no number.
  /// @param level of detail, 1 to k_finest_level: 2^level pieces, linear in between, over the same length.
  explicit GreyGraph(double hurst, int level = k_finest_level) noexcept;

  /// Linear between samples, mirrored at the ends.
  double at(double sample) const noexcept {
    constexpr double last = k_samples - 1;
    double x = std::fmod(std::abs(sample), 2 * last);
    if (x > last) x = 2 * last - x;
    const auto i = static_cast<std::size_t>(x < last - 1 ? x : last - 1);
    const double f = x - static_cast<double>(i);
    return (1 - f) * grey_[i] + f * grey_[i + 1];
  }

 private:
  std::array<double, k_samples> grey_{};
};

}  // namespace papilla
