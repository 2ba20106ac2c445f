// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace papilla::texture_detail {

/// Applies the inverse of 2(α K + λ K²) to a field, K the 5-point −Δ with periodic or reflecting borders.
/// The mean of the result is 0.
class InverseBilaplacian {
 public:
  InverseBilaplacian(int width, int height, bool periodic);
  ~InverseBilaplacian();
  InverseBilaplacian(const InverseBilaplacian&) = delete;
  InverseBilaplacian& operator=(const InverseBilaplacian&) = delete;
  void apply(const std::vector<double>& field, double alpha, double lambda, std::vector<double>& result);

 private:
  class Transform;
  class Periodic;
  class Reflecting;
  std::unique_ptr<Transform> transform_;
};

}  // namespace papilla::texture_detail
