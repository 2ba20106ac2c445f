// SPDX-License-Identifier: MIT
#include "generating_region.hpp"

#include <algorithm>
#include <cmath>

namespace papilla::texture_detail {
namespace {

/// Images of a point under all operations and the translations around; lattice coordinates.
std::vector<Vec2> images(const std::vector<PlaneOperation>& operations, Vec2 origin, Vec2 point) {
  std::vector<Vec2> found;
  const auto add = [&](Vec2 image, bool identity) {
    // Next to the point itself, whatever the operation's own translation.
    image = image - Vec2{std::round(image.x - point.x), std::round(image.y - point.y)};
    for (int v = -2; v <= 2; ++v)
      for (int u = -2; u <= 2; ++u)
        if (!identity || u != 0 || v != 0)
          found.push_back(image + Vec2{static_cast<double>(u), static_cast<double>(v)});
  };
  add(point, true);
  for (std::size_t g = 1; g < operations.size(); ++g) {
    const PlaneOperation& op = operations[g];
    add(apply(op.matrix, point - origin) + origin + Vec2{op.half_u / 2.0, op.half_v / 2.0}, false);
  }
  return found;
}

/// The part of a convex polygon on the side of `keep`, nearer to it than to `other`.
std::vector<Vec2> clipped(const std::vector<Vec2>& polygon, Vec2 keep, Vec2 other) {
  const Vec2 normal = other - keep, middle = 0.5 * (keep + other);
  std::vector<Vec2> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    const double at_p = dot(p - middle, normal), at_q = dot(q - middle, normal);
    if (at_p <= 0) result.push_back(p);
    if ((at_p < 0 && at_q > 0) || (at_p > 0 && at_q < 0)) result.push_back(p + (at_p / (at_p - at_q)) * (q - p));
  }
  return result;
}

/// Without corners that rounding made two of.
std::vector<Vec2> simplified(const std::vector<Vec2>& corners) {
  const double least = 0.01 * std::sqrt(polygon_area(corners));
  std::vector<Vec2> kept;
  for (const Vec2 corner : corners)
    if (kept.empty() || (norm(corner - kept.back()) > least && norm(corner - kept.front()) > least))
      kept.push_back(corner);
  return kept;
}

}  // namespace

double polygon_area(const std::vector<Vec2>& corners) {
  double twice = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) twice += cross(corners[i], corners[(i + 1) % corners.size()]);
  return std::abs(twice) / 2;
}

std::vector<Vec2> generating_region(const std::array<Vec2, 2>& vectors, const std::vector<PlaneOperation>& operations,
                                    Vec2 origin) {
  const auto in_plane = [&](Vec2 p) { return p.x * vectors[0] + p.y * vectors[1]; };
  // The point furthest from its images: a region as round as possible. The grid misses the special positions.
  constexpr int k_grid = 17;
  Vec2 chosen{};
  double furthest = -1;
  for (int j = 0; j < k_grid; ++j)
    for (int i = 0; i < k_grid; ++i) {
      const Vec2 point = origin + Vec2{(i + 0.37) / k_grid, (j + 0.41) / k_grid};
      double nearest = 1e300;
      for (const Vec2 image : images(operations, origin, point))
        nearest = std::min(nearest, norm(in_plane(image - point)));
      if (nearest > furthest * (1 + 1e-9)) {
        furthest = nearest;
        chosen = point;
      }
    }
  const Vec2 centre = in_plane(chosen);
  const double reach = 2 * (norm(vectors[0]) + norm(vectors[1]));
  std::vector<Vec2> region = {centre + Vec2{-reach, -reach}, centre + Vec2{reach, -reach}, centre + Vec2{reach, reach},
                              centre + Vec2{-reach, reach}};
  for (const Vec2 image : images(operations, origin, chosen)) region = clipped(region, centre, in_plane(image));
  return simplified(region);
}

}  // namespace papilla::texture_detail
