// SPDX-License-Identifier: MIT
#include "papilla/haptic/registration.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

constexpr double k_least_height_m = 5e-3;

/// Three points around their centroid, and their plane.
struct Triangle {
  Vec3 centroid, normal, along;
  std::array<Vec3, 3> arms;

  Triangle(const std::array<Vec3, 3>& points, const char* what) {
    for (const Vec3& p : points) {
      if (!is_finite(p)) throw InvalidInput(std::string("registration: a point ") + what + " is not finite");
      centroid = centroid + (1.0 / 3) * p;
    }
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      arms[i] = points[i] - centroid;
      longest = std::max(longest, norm(points[(i + 1) % 3] - points[i]));
    }
    const Vec3 area = cross(points[1] - points[0], points[2] - points[0]);
    if (!(norm(area) >= k_least_height_m * longest) || !(longest > 0))
      throw InvalidInput(std::string("registration: the three points ") + what + " are on a line");
    normal = normalized(area);
    along = normalized(points[1] - points[0]);
  }
};

/// The turn that takes the axes (along, normal × along, normal) to those of the other.
std::array<Vec3, 3> turn(Vec3 along, Vec3 normal, Vec3 to_along, Vec3 to_normal) {
  const Vec3 side = cross(normal, along), to_side = cross(to_normal, to_along);
  const auto row = [&](double x, double y, double z) { return x * along + y * side + z * normal; };
  return {row(to_along.x, to_side.x, to_normal.x), row(to_along.y, to_side.y, to_normal.y),
          row(to_along.z, to_side.z, to_normal.z)};
}

}  // namespace

Registration register_points(const std::array<Vec3, 3>& touched, const std::array<Vec3, 3>& of_part) {
  const Triangle a(touched, "touched"), b(of_part, "of the part");
  Pose pose{turn(a.along, a.normal, b.along, b.normal), {}};
  double sine = 0, cosine = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 turned = pose.turned(a.arms[i]);
    sine += dot(b.normal, cross(turned, b.arms[i]));
    cosine += dot(turned, b.arms[i]);
  }
  const double angle = std::atan2(sine, cosine);
  const Vec3 to_along = std::cos(angle) * b.along + std::sin(angle) * cross(b.normal, b.along);
  pose.rows = turn(a.along, a.normal, to_along, b.normal);
  pose.shift = b.centroid - pose.turned(a.centroid);
  double squares = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 off = pose(touched[i]) - of_part[i];
    squares += dot(off, off);
  }
  return {pose, std::sqrt(squares / 3)};
}

Registration register_plane(const std::array<Vec3, 3>& touched, Vec3 point, Vec3 normal, Vec3 along) {
  const Triangle a(touched, "touched");
  const Vec3 n = normalized(normal), x = normalized(along - dot(along, n) * n);
  if (!is_finite(point) || !(norm(n) > 0) || !(norm(x) > 0))
    throw InvalidInput("registration: the plane of the part has no direction");
  Pose pose{turn(a.along, a.normal, x, n), {}};
  pose.shift = point - pose.turned(touched[0]);
  return {pose, 0};
}

}  // namespace papilla
