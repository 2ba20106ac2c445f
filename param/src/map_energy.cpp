// SPDX-License-Identifier: MIT
#include "map_energy.hpp"

#include <cmath>
#include <limits>

namespace papilla::param_detail {
namespace {

/// (∂J/∂corner)ᵀ of a matrix with the columns x and y.
std::array<Vec2, 3> by_corners(const CornerFactors& f, Vec2 x, Vec2 y) {
  return {f[0][0] * x + f[0][1] * y, f[1][0] * x + f[1][1] * y, f[2][0] * x + f[2][1] * y};
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

void SymmetricDirichlet::hessian(std::size_t triangle, Vec2 a, Vec2 b, Vec2 c, double raised, double* matrix) const {
  // For J as one vector j, with C = ∂det/∂J:
  // 2 (1 + det⁻²) I - 4 det⁻³ (j Cᵀ + C jᵀ) + 6 |J|² det⁻⁴ C Cᵀ - 2 |J|² det⁻³ ∂²det, for unit area.
  const RestShape& rest = rest_[triangle];
  const Jacobian j = jacobian(rest, b - a, c - a);
  const CornerFactors f = corner_factors(rest);
  const double det = j.determinant(), squared = j.squared();
  const double inverse = 1 / det, inverse2 = inverse * inverse, inverse3 = inverse2 * inverse;
  const double diagonal = 2 * rest.area * (1 + inverse2), mixed = -4 * rest.area * inverse3;
  const double pure = 6 * rest.area * squared * inverse2 * inverse2, bend = -2 * rest.area * squared * inverse3;
  const auto own = by_corners(f, j.x, j.y), cofactor = by_corners(f, {j.y.y, -j.y.x}, {-j.x.y, j.x.x});
  // The eigenvalue of the rotation of the polar factor R: J = R S, direction R (0 -1; 1 0) / √2.
  const double eigenvalue = rest.area * (2 - 2 * (squared - det) * inverse3);
  double rotation = 0;
  std::array<Vec2, 3> turn{};
  if (eigenvalue < 0) {
    const Vec2 r{j.x.x + j.y.y, j.x.y - j.y.x};
    // R = (c -s; s c); R (0 -1; 1 0) = (-s -c; c -s), by columns.
    if (const double size = dot(r, r); size > 0) {
      turn = by_corners(f, {-r.y, r.x}, {-r.x, -r.y});
      rotation = -0.5 * raised * eigenvalue / size;
    }
  }
  for (std::size_t q = 0; q < 3; ++q)
    for (std::size_t p = q; p < 3; ++p) {
      const double same = diagonal * (f[p][0] * f[q][0] + f[p][1] * f[q][1]);
      const double skew = bend * (f[p][0] * f[q][1] - f[p][1] * f[q][0]);
      // Rows are corner p's, columns corner q's.
      const Vec2 left = mixed * own[p] + pure * cofactor[p], right = mixed * cofactor[p], turned = rotation * turn[p];
      const Vec2 first = cofactor[q].x * left + own[q].x * right + turn[q].x * turned;
      const Vec2 second = cofactor[q].y * left + own[q].y * right + turn[q].y * turned;
      double* block = matrix + 6 * (2 * q) + 2 * p;
      block[0] = first.x + same, block[1] = first.y - skew;
      block[6] = second.x + skew, block[7] = second.y + same;
    }
}

}  // namespace papilla::param_detail
