// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <vector>

namespace papilla::texture_detail {

/// Share of the variance a group may leave per freed parameter: what interpolation and an inexact period leave.
inline constexpr double k_model_error = 0.03;

/// Fourier coefficients of a periodic row of samples, f(u) = Σ F(m) exp(2πi m u), m from 0 to a quarter of the samples.
class CircleWaves {
 public:
  explicit CircleWaves(const std::vector<double>& samples);
  int highest() const { return static_cast<int>(values_.size()) - 1; }
  std::complex<double> at(int m) const { return values_[static_cast<std::size_t>(m)]; }

 private:
  std::vector<std::complex<double>> values_;
};

}  // namespace papilla::texture_detail
