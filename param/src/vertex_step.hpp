// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "rest_shape.hpp"

namespace papilla::param_detail {

/// A triangle seen from one of its corners: its Jacobian as a function of where the corner goes.
struct CornerView {
  Jacobian at_start;
  double fx = 0, fy = 0;  ///< ∂(J.x)/∂corner and ∂(J.y)/∂corner.
  double area = 0;
};

/// @param from, to the triangle's other corners, counter-clockwise after the corner, relative to it.
inline CornerView corner_view(const RestShape& rest, std::size_t corner, Vec2 from, Vec2 to) {
  const CornerFactors f = corner_factors(rest);
  const auto& own = f[corner];
  const auto &next = f[(corner + 1) % 3], &last = f[(corner + 2) % 3];
  return {{next[0] * from + last[0] * to, next[1] * from + last[1] * to}, own[0], own[1], rest.area};
}

/// Sum of the symmetric Dirichlet energies after the corner has moved by d; infinite when a triangle is not positive.
double corner_energy(std::span<const CornerView> ring, Vec2 d);

/// A safeguarded Newton step for one vertex from a place where the energy is finite.
/// @return by how much the vertex moves: never to a higher energy.
Vec2 corner_step(std::span<const CornerView> ring);

}  // namespace papilla::param_detail
