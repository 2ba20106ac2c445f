// SPDX-License-Identifier: MIT
#include "lift_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "cheapest_ways.hpp"
#include "corners_of_vertices.hpp"

namespace papilla::param_detail {
namespace {

/// How far off a triangle its map goes on, in its edges.
constexpr double k_furthest = 16;

/// A triangle in space, to say where points lie over it.
struct Plane {
  Vec3 origin, p, q, normal;  ///< Of length 2 area.
  double square = 0;          ///< Of the normal.

  Plane(Vec3 a, Vec3 b, Vec3 c) : origin(a), p(b - a), q(c - a), normal(cross(p, q)), square(dot(normal, normal)) {}

  /// Coordinates by the corners of the foot of a point; those of the first corner where the triangle has no area.
  std::array<double, 3> coordinates(Vec3 point) const {
    if (!(square > 0)) return {1, 0, 0};
    const Vec3 d = point - origin;
    const double b = std::clamp(dot(cross(d, q), normal) / square, -k_furthest, k_furthest);
    const double c = std::clamp(dot(cross(p, d), normal) / square, -k_furthest, k_furthest);
    return {1 - b - c, b, c};
  }

  /// How well a point lies over the triangle: 0 in it, less the further off.
  double fit(Vec3 point) const {
    if (!(square > 0)) return -std::numeric_limits<double>::infinity();
    const auto [a, b, c] = coordinates(point);
    const double height = std::abs(dot(point - origin, normal)) / std::pow(square, 0.75);  // over the root of 2 area
    return std::min({a, b, c, 0.0}) - height;
  }
};

class MapLifter {
 public:
  MapLifter(const SeamMesh& fine, const SeamMesh& coarse, std::span<const Index> vertices)
      : fine_(fine.mesh),
        coarse_(coarse.mesh),
        corners_(coarse.mesh.triangles, coarse.mesh.positions.size()),
        nearest_(fine.mesh.positions.size(), k_none) {
    std::vector<Index> number(nearest_.size(), k_none);
    for (Index v = 0; v < vertices.size(); ++v) number[vertices[v]] = v;
    CheapestWays ways(fine);
    ways.search(
        vertices, [&](Index h) { return fine.length(h); }, [](Index, double) { return true; },
        [](Index) { return false; });
    for (Index v = 0; v < nearest_.size(); ++v) {
      if (!ways.has_reached(v)) continue;
      const std::vector<Index> way = ways.way_to(v);
      nearest_[v] = number[way.empty() ? v : fine.from(way.front())];
    }
  }

  CornerAttribute<Vec2> lift(const CornerAttribute<Vec2>& uv) const {
    CornerAttribute<Vec2> lifted;
    lifted.indices.reserve(fine_.triangles.size());
    for (const Triangle& t : fine_.triangles) {
      const Index under = triangle_under(t), first = static_cast<Index>(lifted.values.size());
      const Plane plane = plane_of(under);
      const Triangle& corners = uv.indices[under];
      for (const Index v : t) {
        const auto [a, b, c] = plane.coordinates(fine_.positions[v]);
        lifted.values.push_back(a * uv.values[corners[0]] + b * uv.values[corners[1]] + c * uv.values[corners[2]]);
      }
      lifted.indices.push_back({first, first + 1, first + 2});
    }
    return lifted;
  }

 private:
  static constexpr Index k_none = ~Index{0};

  Plane plane_of(Index t) const {
    const auto [a, b, c] = coarse_.triangles[t];
    return {coarse_.positions[a], coarse_.positions[b], coarse_.positions[c]};
  }

  Index triangle_under(const Triangle& t) const {
    const auto [a, b, c] = t;
    const Vec3 p = fine_.positions[a], q = fine_.positions[b], r = fine_.positions[c];
    const Vec3 middle = (1.0 / 3) * (p + q + r);
    Index best = 0;
    double most = -std::numeric_limits<double>::infinity();
    for (const Index v : t) {
      if (nearest_[v] == k_none) continue;
      for (const Index corner : corners_.of(nearest_[v]))
        if (const double fit = plane_of(corner / 3).fit(middle); fit > most) most = fit, best = corner / 3;
    }
    return best;
  }

  const TriangleMesh &fine_, &coarse_;
  CornersOfVertices corners_;
  std::vector<Index> nearest_;  ///< Per vertex of the fine mesh: the coarse one nearest to it over edges.
};

}  // namespace

CornerAttribute<Vec2> lift_map(const SeamMesh& fine, const SeamMesh& coarse, std::span<const Index> vertices,
                               const CornerAttribute<Vec2>& uv) {
  return MapLifter(fine, coarse, vertices).lift(uv);
}

}  // namespace papilla::param_detail
