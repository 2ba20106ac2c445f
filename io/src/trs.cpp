// SPDX-License-Identifier: MIT
#include "trs.hpp"

#include <algorithm>
#include <cmath>

namespace papilla {
namespace {

constexpr double k_max_shear = 1e-4;

Vec3 column(const Transform& t, std::size_t i) { return {t[i], t[4 + i], t[8 + i]}; }

Vec3 any_perpendicular(Vec3 a) {
  const Vec3 axis = std::abs(a.x) <= std::abs(a.y) && std::abs(a.x) <= std::abs(a.z) ? Vec3{1, 0, 0}
                    : std::abs(a.y) <= std::abs(a.z)                                 ? Vec3{0, 1, 0}
                                                                                     : Vec3{0, 0, 1};
  return normalized(cross(a, axis));
}

/// Gives axes that a scale of zero has wiped out a direction.
void complete(std::array<Vec3, 3>& axes) {
  const auto missing = [&](std::size_t i) { return axes[i] == Vec3{}; };
  if (missing(0) && missing(1) && missing(2)) axes[0] = {1, 0, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3, last = (i + 2) % 3;
    if (!missing(i) && missing(next) && missing(last)) axes[next] = any_perpendicular(axes[i]);
  }
  for (std::size_t i = 0; i < 3; ++i)
    if (missing(i)) axes[i] = cross(axes[(i + 1) % 3], axes[(i + 2) % 3]);
}

/// Shepperd, "Quaternion from rotation matrix", Journal of Guidance and Control 1 (1978).
std::array<double, 4> quaternion(const std::array<Vec3, 3>& a) {
  const double trace = a[0].x + a[1].y + a[2].z;
  const std::array<double, 4> candidates = {a[0].x, a[1].y, a[2].z, trace};
  std::array<double, 4> q{};
  switch (std::max_element(candidates.begin(), candidates.end()) - candidates.begin()) {
    case 0: q = {1 + 2 * a[0].x - trace, a[0].y + a[1].x, a[0].z + a[2].x, a[1].z - a[2].y}; break;
    case 1: q = {a[0].y + a[1].x, 1 + 2 * a[1].y - trace, a[1].z + a[2].y, a[2].x - a[0].z}; break;
    case 2: q = {a[0].z + a[2].x, a[1].z + a[2].y, 1 + 2 * a[2].z - trace, a[0].y - a[1].x}; break;
    default: q = {a[1].z - a[2].y, a[2].x - a[0].z, a[0].y - a[1].x, 1 + trace}; break;
  }
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (double& component : q) component /= length;
  return q;
}

/// Without the last bits, which are noise: a file that is read and written again and again stays as it is.
double without_noise(double value) {
  constexpr double k_steps = 0x1p44;
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  return std::ldexp(std::round(mantissa * k_steps) / k_steps, exponent);
}

}  // namespace

std::optional<Trs> decompose(const Transform& transform) {
  std::array<Vec3, 3> axes = {column(transform, 0), column(transform, 1), column(transform, 2)};
  Trs trs;
  trs.translation = column(transform, 3);
  trs.scale = {norm(axes[0]), norm(axes[1]), norm(axes[2])};
  for (Vec3& axis : axes) axis = normalized(axis);
  for (std::size_t i = 0; i < 3; ++i)
    if (std::abs(dot(axes[i], axes[(i + 1) % 3])) > k_max_shear) return std::nullopt;
  complete(axes);
  if (dot(cross(axes[0], axes[1]), axes[2]) < 0) {
    axes[2] = -axes[2];
    trs.scale.z = -trs.scale.z;
  }
  trs.rotation = quaternion(axes);
  for (double& component : trs.rotation) component = without_noise(component);
  for (double* scale : {&trs.scale.x, &trs.scale.y, &trs.scale.z}) *scale = without_noise(*scale);
  return trs;
}

}  // namespace papilla
