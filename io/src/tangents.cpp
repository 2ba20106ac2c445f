// SPDX-License-Identifier: MIT
#include "tangents.hpp"

#include <algorithm>
#include <cmath>

namespace papilla {
namespace {

double angle_between(Vec3 a, Vec3 b) {
  const double lengths = norm(a) * norm(b);
  return lengths > 0 ? std::acos(std::clamp(dot(a, b) / lengths, -1.0, 1.0)) : 0;
}

/// ∂p/∂u of the triangle's affine map from uv to space, up to a positive factor.
Vec3 u_direction(const std::array<Vec3, 3>& p, const std::array<Vec2, 3>& uv) {
  const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
  const double sign = cross(a, b) < 0 ? -1 : 1;
  return normalized(sign * (b.y * (p[1] - p[0]) - a.y * (p[2] - p[0])));
}

Vec3 perpendicular_to(Vec3 normal) {
  const Vec3 axis = std::abs(normal.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  return normalized(axis - dot(axis, normal) * normal);
}

}  // namespace

float tangent_handedness(const std::array<Vec2, 3>& uv) {
  return cross(uv[1] - uv[0], uv[2] - uv[0]) < 0 ? -1.0F : 1.0F;
}

std::vector<std::array<float, 4>> vertex_tangents(std::span<const Vec3> positions, std::span<const Vec3> normals,
                                                  std::span<const Vec2> uv, std::span<const Triangle> triangles) {
  std::vector<Vec3> sums(positions.size());
  std::vector<float> handedness(positions.size(), 1);
  for (const Triangle& t : triangles) {
    const std::array<Vec3, 3> p = {positions[t[0]], positions[t[1]], positions[t[2]]};
    const std::array<Vec2, 3> q = {uv[t[0]], uv[t[1]], uv[t[2]]};
    const Vec3 direction = u_direction(p, q);
    for (std::size_t k = 0; k < 3; ++k) {
      sums[t[k]] = sums[t[k]] + angle_between(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]) * direction;
      handedness[t[k]] = tangent_handedness(q);
    }
  }
  std::vector<std::array<float, 4>> tangents;
  tangents.reserve(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const Vec3 flat = sums[i] - dot(sums[i], normals[i]) * normals[i];
    // Below this the direction is rounding noise: the sum's weights are angles, of order 1.
    const Vec3 t = norm(flat) > 1e-6 ? normalized(flat) : perpendicular_to(normals[i]);
    tangents.push_back({static_cast<float>(t.x), static_cast<float>(t.y), static_cast<float>(t.z), handedness[i]});
  }
  return tangents;
}

}  // namespace papilla
