// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

namespace papilla::texture_detail {

/// The inverse of 2(α K + λ K²), K the 5-point −Δ with periodic or reflecting borders.
class InverseBilaplacian {
 public:
  virtual ~InverseBilaplacian() = default;
  virtual void set(double alpha, double lambda) = 0;
  /// The mean of the result is 0.
  virtual void apply(const std::vector<double>& field, std::vector<double>& result) = 0;
};

std::unique_ptr<InverseBilaplacian> make_inverse_bilaplacian(int width, int height, bool periodic);

}  // namespace papilla::texture_detail
