// SPDX-License-Identifier: MIT
// Which triangles lie with those around them on a plane or an arch.
#include <algorithm>
#include <cmath>

#include "contact_fan.hpp"

namespace papilla {
namespace {

constexpr double k_highest_step = 0.5;  // Of the tolerance.
constexpr double k_most_spread = 0.6;   // Radians between the normals.
constexpr double k_hollow = 1e-3;       // Radians: a hollow by less moves the closest point by less than the tolerance.

/// Tangent of the largest angle between two normals, from the angles to their mean.
double tilt_of(std::span<const Vec3> normals) noexcept {
  Vec3 sum;
  for (const Vec3& normal : normals) sum = sum + normal;
  const Vec3 middle = normalized(sum);
  double sine = 0, cosine = 1;
  for (const Vec3& normal : normals) {
    sine = std::max(sine, norm(cross(normal, middle)));
    cosine = std::min(cosine, dot(normal, middle));
  }
  const double angle = 2 * std::atan2(sine, cosine);
  return angle < k_most_spread ? std::tan(angle) : 1;
}

/// By how much of its height a relief may end in a step at a corner with these triangles around. A triangle leaves the
/// places above the corner on one side of the plane that is orthogonal to an edge; there the two at the edge count. The
/// relief of each seems as high as the cosine to its normal, and in the middle between these two another may be ahead.
double step_of(std::span<const Vec3> normals) noexcept {
  double step = 0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Vec3 middle = normalized(normals[i] + normals[(i + 1) % normals.size()]);
    for (const Vec3& other : normals) step = std::max(step, dot(other - normals[i], middle));
  }
  return step;
}

}  // namespace

/// By the fans around all corners, each looked at once.
/// @param opposite for directed edge 3·slot + k that of the triangle behind it, or k_no_place.
/// @param place_at the place by slot.
void ContactTriangles::find_arches(std::span<const std::uint32_t> opposite, std::span<const std::uint32_t> place_at) {
  std::vector<std::array<float, 3>> normals;
  normals.reserve(place_at.size());
  for (const std::uint32_t place : place_at) {
    const Vec3 n = face_normal(place);
    normals.push_back({static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
  }
  const auto normal_at = [&](std::size_t slot) {
    const auto& [x, y, z] = normals[slot];
    return Vec3{double{x}, double{y}, double{z}};
  };
  // Bit k: the triangle behind edge k rises above the plane; bit 3 + k: corner k is done.
  std::vector<std::uint8_t> flags(place_at.size());
  for (std::size_t slot = 0; slot < place_at.size(); ++slot) {
    const std::array<Vec3, 3> c = corners(place_at[slot]).all();
    for (std::size_t k = 0; k < 3; ++k) {
      if (opposite[3 * slot + k] == k_no_place) continue;
      const Vec3 edge = c[(k + 1) % 3] - c[k], turn = cross(normal_at(opposite[3 * slot + k] / 3), normal_at(slot));
      if (dot(turn, edge) > k_hollow * norm(edge)) flags[slot] |= static_cast<std::uint8_t>(1U << k);
    }
  }
  std::array<std::size_t, k_most_around> fan;
  std::array<Vec3, k_most_around> fan_normals;
  for (std::uint32_t first = 0; first < opposite.size(); ++first) {
    if ((flags[first / 3] >> (3 + first % 3) & 1U) != 0) continue;
    std::size_t count = 0;
    bool ends = false, hollow = false;
    for (std::uint32_t edge = first; count < fan.size() && !ends;) {
      fan[count] = edge / 3;
      fan_normals[count++] = normal_at(edge / 3);
      flags[edge / 3] |= static_cast<std::uint8_t>(8U << edge % 3);
      hollow = hollow || (flags[edge / 3] >> edge % 3 & 1U) != 0;
      const std::uint32_t there = opposite[edge];
      if (there == k_no_place) break;
      edge = there - there % 3 + (there + 1) % 3;
      ends = edge == first;
    }
    const std::span around(fan_normals.data(), count);
    const bool goes_round = ends && !hollow && step_of(around) * tallest_ < k_highest_step * tolerance_m();
    const double tilt = goes_round ? tilt_of(around) : 1;
    const auto code = tilt < 1 ? static_cast<std::uint16_t>(std::ceil(k_tilts * tilt)) : k_no_arch;
    for (std::size_t i = 0; i < count; ++i) arch_[fan[i]] = std::max(arch_[fan[i]], code);
  }
}

}  // namespace papilla
