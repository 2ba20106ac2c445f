// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <complex>
#include <vector>

#include "fft.hpp"

namespace papilla::texture_detail {

/// Multiplies the cosine transform (DCT-II, of reflecting borders) of a field by a gain, and transforms back.
class CosineFilter2d {
 public:
  CosineFilter2d(int width, int height);

  /// @param gains  width · height values, row by row, of the coefficients (u, v): waves of u/2 and v/2 periods.
  void apply(const std::vector<double>& field, const std::vector<double>& gains, std::vector<double>& result);

 private:
  void multiply(const std::vector<double>& gains);

  int width_, height_;
  RealFft2d fft_;
  std::vector<std::complex<double>> across_, down_;  ///< e^(−iπk/2n).
};

}  // namespace papilla::texture_detail
