// SPDX-License-Identifier: MIT
#include <cmath>
#include <string>

#include "check_mesh.hpp"
#include "mesh_frame.hpp"
#include "papilla/core/error.hpp"
#include "papilla/param/grain_direction.hpp"
#include "place_charts.hpp"

namespace papilla {
namespace {

using namespace param_detail;

constexpr const char* k_function = "turn_to_grain";

/// Charts whose mean direction is shorter than this fraction of their area have none.
constexpr double k_least_mean = 0.05;

/// The image of a direction of space under a triangle's map to uv, and the triangle's area; zero without area.
struct Image {
  Vec2 direction;
  double area = 0;
};

Image image_of(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv, std::size_t t, Vec3 direction) {
  const Vec3 p = mesh.corner(t, 1) - mesh.corner(t, 0), q = mesh.corner(t, 2) - mesh.corner(t, 0);
  const auto& [a, b, c] = uv.indices[t];
  const Vec2 m = uv.values[b] - uv.values[a], n = uv.values[c] - uv.values[a];
  const Vec3 doubled = cross(p, q);
  const double square = dot(doubled, doubled);
  if (!(square > 0)) return {};
  // The tangential part of the direction is x p + y q.
  const double x = dot(cross(direction, q), doubled) / square, y = dot(cross(p, direction), doubled) / square;
  const Vec3 tangential = direction - (dot(direction, doubled) / square) * doubled;
  const Vec2 image = x * m + y * n;
  const double size = norm(image);
  if (!(size > 0) || !std::isfinite(size)) return {};
  return {(norm(tangential) / size) * image, 0.5 * std::sqrt(square)};
}

/// @param direction_of of length 1 for every triangle.
template <class DirectionOf>
CornerAttribute<Vec2> turned(const TriangleMesh& mesh, const Flattening& flattening, DirectionOf direction_of) {
  const auto& chart_of = flattening.charts.of_triangle;
  std::vector<Vec2> mean(flattening.charts.count);
  std::vector<double> area(flattening.charts.count, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Image image = image_of(mesh, flattening.uv, t, direction_of(t));
    mean[chart_of[t]] = mean[chart_of[t]] + image.area * image.direction;
    area[chart_of[t]] += image.area;
  }
  CornerAttribute<Vec2> uv = flattening.uv;
  std::vector<char> done(uv.values.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const Index i : uv.indices[t]) {
      const Vec2 m = mean[chart_of[t]];
      const double length = norm(m);
      if (done[i] || !(length > k_least_mean * area[chart_of[t]])) continue;
      done[i] = 1;
      // Turns m to (0, 1): multiplication with (m.y + i m.x) / length.
      const Vec2 p = uv.values[i];
      uv.values[i] = {(p.x * m.y - p.y * m.x) / length, (p.x * m.x + p.y * m.y) / length};
    }
  return uv;
}

void check(const TriangleMesh& mesh, const Flattening& flattening) {
  check_mesh(mesh, k_function);
  check_charts(mesh, flattening.charts, k_function);
  check_uv(mesh, flattening.uv, k_function);
}

}  // namespace

Vec3 longest_direction(const TriangleMesh& mesh) {
  check_mesh(mesh, "longest_direction");
  Vec3 middle;
  double area = 0;
  const auto area_of = [&](std::size_t t) {
    return 0.5 * norm(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
  };
  const auto centre = [&](std::size_t t) {
    return (1.0 / 3) * (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2));
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) middle = middle + area_of(t) * centre(t), area += area_of(t);
  if (!(area > 0)) return {0, 0, 1};
  middle = (1 / area) * middle;
  std::array<Vec3, 3> rows{};
  const auto add = [&](Vec3 q, double weight) {
    rows[0] = rows[0] + (weight * q.x) * q, rows[1] = rows[1] + (weight * q.y) * q,
    rows[2] = rows[2] + (weight * q.z) * q;
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    // The integral of q qᵀ over a triangle: A / 12 (Σ over corners + 9 times the centre's).
    const double weight = area_of(t) / (12 * area);
    for (int k = 0; k < 3; ++k) add(mesh.corner(t, k) - middle, weight);
    add(centre(t) - middle, 9 * weight);
  }
  const Vec3 d = principal_axis(rows);
  double largest = d.x;
  for (const double c : {d.y, d.z})
    if (std::abs(c) > std::abs(largest)) largest = c;
  return largest < 0 ? -d : d;
}

CornerAttribute<Vec2> turn_to_grain(const TriangleMesh& mesh, const Flattening& flattening, Vec3 direction) {
  check(mesh, flattening);
  if (!is_finite(direction) || !(norm(direction) > 0))
    throw InvalidInput(std::string(k_function) + ": direction is not a finite vector with a length");
  direction = normalized(direction);
  return turned(mesh, flattening, [direction](std::size_t) { return direction; });
}

CornerAttribute<Vec2> turn_to_grain(const TriangleMesh& mesh, const Flattening& flattening, const EdgeLoop& loop) {
  check(mesh, flattening);
  if (loop.points.size() < 2) throw InvalidInput(std::string(k_function) + ": the loop has fewer than two points");
  return turned(mesh, flattening, [&](std::size_t t) {
    return direction_near(loop, (1.0 / 3) * (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)));
  });
}

}  // namespace papilla
