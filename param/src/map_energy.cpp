// SPDX-License-Identifier: MIT
#include "map_energy.hpp"

#include <cmath>
#include <limits>

namespace papilla::param_detail {
namespace {

/// The projected Hessian by the four numbers of J, in the order (∂u/∂x, ∂v/∂x, ∂u/∂y, ∂v/∂y), for unit area.
using JacobianHessian = std::array<std::array<double, 4>, 4>;

JacobianHessian jacobian_hessian(const Jacobian& j) {
  const double det = j.determinant(), squared = j.squared();
  const double inverse = 1 / det, inverse2 = inverse * inverse, inverse3 = inverse2 * inverse;
  const std::array<double, 4> a{j.x.x, j.x.y, j.y.x, j.y.y};
  const std::array<double, 4> cofactor{j.y.y, -j.y.x, -j.x.y, j.x.x};  // ∂det/∂J
  JacobianHessian h;
  const double mixed = -4 * inverse3, pure = 6 * squared * inverse2 * inverse2;
  for (std::size_t r = 0; r < 4; ++r)
    for (std::size_t c = 0; c < 4; ++c)
      h[r][c] = mixed * (a[r] * cofactor[c] + cofactor[r] * a[c]) + pure * cofactor[r] * cofactor[c];
  for (std::size_t r = 0; r < 4; ++r) h[r][r] += 2 * (1 + inverse2);
  const double bend = -2 * squared * inverse3;  // times ∂²det
  h[0][3] += bend, h[3][0] += bend, h[1][2] -= bend, h[2][1] -= bend;
  // The eigenvalue of the rotation of the polar factor R: J = R S, direction R (0 -1; 1 0) / √2.
  const double rotation = 2 - 2 * (squared - det) * inverse3;
  if (rotation < 0) {
    double c = j.x.x + j.y.y, s = j.x.y - j.y.x;
    const double size = std::sqrt(c * c + s * s);
    if (size > 0) {
      c /= size, s /= size;
      // R = (c -s; s c); R (0 -1; 1 0) = (-s -c; c -s), by columns.
      const std::array<double, 4> turn{-s, c, -c, -s};
      for (std::size_t r = 0; r < 4; ++r)
        for (std::size_t k = 0; k < 4; ++k) h[r][k] -= 0.5 * rotation * turn[r] * turn[k];
    }
  }
  return h;
}

}  // namespace

double SymmetricDirichlet::value(std::size_t triangle, Vec2 a, Vec2 b, Vec2 c) const {
  const Jacobian j = jacobian(rest_[triangle], b - a, c - a);
  const double det = j.determinant();
  if (!(det > 0)) return std::numeric_limits<double>::infinity();
  return rest_[triangle].area * j.squared() * (1 + 1 / (det * det));
}

CornerGradient SymmetricDirichlet::gradient(std::size_t triangle, Vec2 a, Vec2 b, Vec2 c) const {
  const RestShape& rest = rest_[triangle];
  const Jacobian j = jacobian(rest, b - a, c - a);
  const double inverse = 1 / j.determinant(), inverse2 = inverse * inverse;
  const double along = rest.area * 2 * (1 + inverse2), across = -rest.area * 2 * j.squared() * inverse2 * inverse;
  const Vec2 x = along * j.x + across * Vec2{j.y.y, -j.y.x}, y = along * j.y + across * Vec2{-j.x.y, j.x.x};
  const CornerFactors f = corner_factors(rest);
  return {f[0][0] * x + f[0][1] * y, f[1][0] * x + f[1][1] * y, f[2][1] * y};
}

void SymmetricDirichlet::hessian(std::size_t triangle, Vec2 a, Vec2 b, Vec2 c, double* matrix) const {
  const RestShape& rest = rest_[triangle];
  const JacobianHessian h = jacobian_hessian(jacobian(rest, b - a, c - a));
  const CornerFactors f = corner_factors(rest);
  // Rows of J's Hessian times the factors of each corner, first on one side, then on the other.
  double half[4][6];
  for (std::size_t r = 0; r < 4; ++r)
    for (std::size_t corner = 0; corner < 3; ++corner)
      for (std::size_t k = 0; k < 2; ++k)
        half[r][2 * corner + k] = rest.area * (f[corner][0] * h[r][k] + f[corner][1] * h[r][k + 2]);
  for (std::size_t column = 0; column < 6; ++column)
    for (std::size_t corner = column / 2; corner < 3; ++corner)
      for (std::size_t k = 0; k < 2; ++k)
        matrix[6 * column + 2 * corner + k] = f[corner][0] * half[k][column] + f[corner][1] * half[k + 2][column];
}

}  // namespace papilla::param_detail
