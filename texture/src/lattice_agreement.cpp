// SPDX-License-Identifier: MIT
#include "papilla/texture/lattice_agreement.hpp"

#include <cmath>

namespace papilla {
namespace {

/// v in coordinates of the basis is whole to within a tenth.
bool is_node(Vec2 v, const std::array<Vec2, 2>& basis) {
  constexpr double k_tolerance = 0.1;
  const double area = cross(basis[0], basis[1]);
  const double m = cross(v, basis[1]) / area, n = cross(basis[0], v) / area;
  return std::abs(m - std::round(m)) <= k_tolerance && std::abs(n - std::round(n)) <= k_tolerance;
}

}  // namespace

bool is_same_lattice(const Lattice& a, const Lattice& b) {
  if (!a.found || !b.found) return false;
  const auto &own = a.vectors_px, &other = b.vectors_px;
  return is_node(own[0], other) && is_node(own[1], other) && is_node(other[0], own) && is_node(other[1], own);
}

void LatticeAgreement::add(const Lattice& middle, const Lattice& piece) {
  if (middle.found == piece.found && (!middle.found || is_same_lattice(middle, piece)))
    ++same;
  else
    ++(piece.found ? other : none);
}

}  // namespace papilla
