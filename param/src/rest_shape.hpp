// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::param_detail {

/// A triangle in its own plane, corners (0,0), (base,0), (along,height), as the inverse of its matrix of edges
/// (base along; 0 height): what the derivative of a map is made of.
struct RestShape {
  double x1 = 0, y1 = 0, y2 = 0;  ///< 1 / base, -along / (base height), 1 / height.
  double area = 0;
  double base() const { return 1 / x1; }
  double height() const { return 1 / y2; }
  double along() const { return -y1 / (x1 * y2); }
};

/// Triangles with less than this fraction of their longest edge squared as doubled area count as having it: that keeps
/// the shape of triangles without area finite, and is below what any measured triangle that matters has.
inline constexpr double k_least_shape = 1e-10;

/// The area that triangles count as having at least. Those of less are made higher, or wider where they are high.
struct LeastArea {
  double area = 0;
  double shape = std::numeric_limits<double>::infinity();  ///< Only where 2 area / longest edge² is below this.
};

/// @param least_edge what triangles of length zero count as; positive.
inline RestShape rest_shape(Vec3 a, Vec3 b, Vec3 c, double least_edge, LeastArea least_area = {}) {
  const Vec3 p = b - a, q = c - a;
  const double length = norm(p), longest = std::max({length, norm(q), norm(c - b), least_edge});
  const double doubled = norm(cross(p, q)), square = longest * longest;
  const double least = std::max(doubled < least_area.shape * square ? 2 * least_area.area : 0, k_least_shape * square);
  double base = length, along = length > 0 ? dot(p, q) / length : 0, height = length > 0 ? doubled / length : 0;
  if (doubled < least) {
    const bool wide = 10 * length > longest;
    base = wide ? length : least / longest;
    along = wide ? along : 0.5 * base;
    height = wide ? least / length : longest;
  }
  const double x1 = 1 / base, y2 = 1 / height;
  return {x1, -along * x1 * y2, y2, 0.5 * base * height};
}

/// What edges of length zero count as: a tiny fraction of the mesh's mean edge.
double least_edge(std::span<const Vec3> positions, std::span<const Triangle> triangles);

std::vector<RestShape> rest_shapes(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                   LeastArea least_area = {});

/// The derivative of the map: columns ∂(u,v)/∂x and ∂(u,v)/∂y, from the edges m (to the second corner) and n (to the
/// third).
struct Jacobian {
  Vec2 x, y;
  double determinant() const { return cross(x, y); }
  double squared() const { return dot(x, x) + dot(y, y); }
};

inline Jacobian jacobian(const RestShape& rest, Vec2 m, Vec2 n) { return {rest.x1 * m, rest.y1 * m + rest.y2 * n}; }

/// ∂J/∂corner: row i holds the factors of corner i in the two columns of J.
using CornerFactors = std::array<std::array<double, 2>, 3>;

inline CornerFactors corner_factors(const RestShape& rest) {
  return {{{-rest.x1, -rest.y1 - rest.y2}, {rest.x1, rest.y1}, {0, rest.y2}}};
}

}  // namespace papilla::param_detail
