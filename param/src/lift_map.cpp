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
    const double length = std::sqrt(square * std::sqrt(square));  // of the normal, times the root of 2 area
    const double height = std::abs(dot(point - origin, normal)) / length;
    return std::min({a, b, c, 0.0}) - height;
  }
};

Plane plane_of(const TriangleMesh& mesh, Index triangle) {
  const auto [a, b, c] = mesh.triangles[triangle];
  return {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
}

constexpr Index k_none = ~Index{0};

/// Per vertex of the fine mesh: the coarse one nearest to it over edges.
std::vector<Index> nearest_vertices(const SeamMesh& fine, std::span<const Index> vertices) {
  std::vector<Index> number(fine.on_border.size(), k_none), nearest = number;
  for (Index v = 0; v < vertices.size(); ++v) number[vertices[v]] = v;
  CheapestWays ways(fine);
  ways.search(
      vertices, [&](Index h) { return fine.length(h); }, [](Index, double) { return true; },
      [](Index) { return false; });
  for (Index v = 0; v < nearest.size(); ++v) {
    if (!ways.has_reached(v)) continue;
    const std::vector<Index> way = ways.way_to(v);
    nearest[v] = number[way.empty() ? v : fine.from(way.front())];
  }
  return nearest;
}

}  // namespace

MapLifter::MapLifter(const SeamMesh& fine, const SeamMesh& coarse, std::span<const Index> vertices)
    : fine_(fine.mesh), coarse_(coarse.mesh) {
  const CornersOfVertices corners(coarse_.triangles, coarse_.positions.size());
  const std::vector<Index> nearest = nearest_vertices(fine, vertices);
  std::vector<Plane> planes;
  planes.reserve(coarse_.triangles.size());
  for (Index t = 0; t < coarse_.triangles.size(); ++t) planes.push_back(plane_of(coarse_, t));
  under_.reserve(fine_.triangles.size());
  for (const Triangle& t : fine_.triangles) {
    const Vec3 middle = (1.0 / 3) * (fine_.positions[t[0]] + fine_.positions[t[1]] + fine_.positions[t[2]]);
    Index best = 0;
    double most = -std::numeric_limits<double>::infinity();
    for (const Index v : t) {
      if (nearest[v] == k_none) continue;
      for (const Index corner : corners.of(nearest[v]))
        if (const double fit = planes[corner / 3].fit(middle); fit > most) most = fit, best = corner / 3;
    }
    under_.push_back(best);
  }
}

CornerAttribute<Vec2> MapLifter::lift(const CornerAttribute<Vec2>& uv) const {
  CornerAttribute<Vec2> lifted;
  lifted.values.reserve(3 * under_.size());
  lifted.indices.reserve(under_.size());
  for (std::size_t t = 0; t < under_.size(); ++t) {
    const Index first = static_cast<Index>(lifted.values.size());
    const Plane plane = plane_of(coarse_, under_[t]);
    const Triangle& corners = uv.indices[under_[t]];
    for (const Index v : fine_.triangles[t]) {
      const auto [a, b, c] = plane.coordinates(fine_.positions[v]);
      lifted.values.push_back(a * uv.values[corners[0]] + b * uv.values[corners[1]] + c * uv.values[corners[2]]);
    }
    lifted.indices.push_back({first, first + 1, first + 2});
  }
  return lifted;
}

}  // namespace papilla::param_detail
