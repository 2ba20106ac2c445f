// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "papilla/core/vec.hpp"

namespace papilla::detail {

/// A triangle's longest edge and the altitude on it (its smallest).
struct TriangleShape {
  double longest_edge = 0, altitude = 0;
  std::size_t longest_corner = 0;  ///< The longest edge runs from this corner to the next.
};

inline TriangleShape triangle_shape(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  const double length[3] = {norm(b - a), norm(c - b), norm(a - c)};
  const std::size_t k = length[0] >= length[1] && length[0] >= length[2] ? 0 : length[1] >= length[2] ? 1 : 2;
  if (!(length[k] > 0)) return {};
  return {length[k], norm(cross(b - a, c - a)) / length[k], k};
}

/// A triangle is degenerate when its smallest altitude is below this fraction of its part's bounding diagonal.
inline constexpr double k_degenerate_altitude = 1e-7;

/// Two boundary features closer than this fraction of the bounding diagonal are taken as touching: the noise that
/// single-precision coordinates and CAD kernels leave on shared edges.
inline constexpr double k_touching_distance = 1e-6;

}  // namespace papilla::detail
