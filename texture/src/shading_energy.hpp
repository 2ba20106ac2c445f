// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/texture/shape_from_shading.hpp"

namespace papilla::texture_detail {

/// E(Z) of shape_from_shading_variational() and its gradient.
class ShadingEnergy {
 public:
  using Field = std::vector<double>;

  ShadingEnergy(const GreyImage& image, const ShadingOptions& options);

  double value_and_gradient(const Field& z, double lambda, Field& gradient);

  double residual() const noexcept { return residual_; }  ///< Root mean square of the last evaluation's I − R.
  Vec3 light() const noexcept { return light_; }
  const Field& image() const noexcept { return brightness_; }

 private:
  void laplacian_row(const Field& z, int y, double factor, double* result) const;
  double take_laplacian(const Field& z);
  double add_shading(const Field& z, Field& gradient);

  int width_, height_;
  bool periodic_;
  Vec3 light_;
  Field brightness_, laplacian_;
  Field across_, down_, squares_;  ///< Of one row: derivatives of the energy by the two differences, squared errors.
  double residual_ = 0;
};

}  // namespace papilla::texture_detail
