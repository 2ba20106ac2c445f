// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "papilla/core/bounds.hpp"

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

/// The length that the fractions below are of: the bounding diagonal, or 0.6 of the farthest corner's distance from the
/// origin where that is more. Files hold single precision, which moves a vertex at distance r by up to r / 2^24, at
/// most 1e-7 of this length.
inline double reference_length(const Bounds3& bounds) noexcept {
  if (bounds.is_empty()) return 0;
  return std::max(bounds.diagonal(), 0.6 * norm(upper(bounds.high, -bounds.low)));
}

/// The most that single precision moves a vertex, as a fraction of reference_length().
inline constexpr double k_rounding_distance = 1e-7;

/// A triangle is degenerate when its smallest altitude is below this fraction of its part's reference length.
inline constexpr double k_degenerate_altitude = 1e-7;

/// What a repair looks for: rounding both ends of an altitude does not make a triangle that it leaves degenerate.
inline constexpr double k_sought_altitude = k_degenerate_altitude + 2 * k_rounding_distance;

/// The same in what a repair makes; the distance to what is looked for keeps a repair of the rounded result idle.
inline constexpr double k_repaired_altitude = k_sought_altitude + k_rounding_distance;

/// Two boundary features closer than this fraction of the reference length are taken as touching: the noise that
/// single-precision coordinates and CAD kernels leave on shared edges.
inline constexpr double k_touching_distance = 1e-6;

}  // namespace papilla::detail
