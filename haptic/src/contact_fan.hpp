// SPDX-License-Identifier: MIT
#pragma once

#include "contact_triangles.hpp"

namespace papilla {

/// Most triangles that may surround a corner, so that a tick has a bound.
constexpr int k_most_around = 32;

/// Calls visit(place, corner) for the triangles around corner k of a triangle, one after the other clockwise across
/// edges over which the relief goes on, until it is back. @returns false when it does not come back.
template <class Visit>
bool ContactTriangles::around(std::uint32_t place, std::uint32_t k, const Visit& visit) const noexcept {
  std::uint32_t at = place, corner = k;
  for (int count = 0; count < k_most_around; ++count) {
    visit(at, corner);
    const std::uint32_t next = continued(at)[corner];
    if (next == place) return true;
    if (next == k_no_place) return false;
    corner = (edge_towards(next, at) + 1) % 3;
    at = next;
  }
  return false;
}

}  // namespace papilla
