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

/// By the fans around all corners, each looked at once. In 13 bytes a triangle besides the result.
void ContactTriangles::find_arches() {
  const auto for_each = [&](const auto& visit) {
    for (std::uint32_t cluster = 0; cluster < clusters_.clusters(); ++cluster)
      for (std::uint32_t i = 0; i < clusters_.triangles_of(cluster); ++i) visit(cluster * TriangleClusters::k_most + i);
  };
  std::vector<std::array<float, 3>> normals;  // By slot.
  normals.reserve(continued_.size());
  for_each([&](std::uint32_t place) {
    const Vec3 n = face_normal(place);
    normals.push_back({static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
  });
  const auto normal_at = [&](std::uint32_t slot) {
    const auto& [x, y, z] = normals[slot];
    return Vec3{double{x}, double{y}, double{z}};
  };
  // By slot. Bit k: the triangle behind edge k rises above the plane; bit 3 + k: corner k is done.
  std::vector<std::uint8_t> flags(continued_.size());
  for_each([&](std::uint32_t place) {
    const std::uint32_t slot = clusters_.slot(place);
    const std::array<Vec3, 3> c = corners(place).all();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t behind = continued_[slot][k];
      if (behind == k_no_place) continue;
      const Vec3 edge = c[(k + 1) % 3] - c[k], turn = cross(normal_at(clusters_.slot(behind)), normal_at(slot));
      if (dot(turn, edge) > k_hollow * norm(edge)) flags[slot] |= static_cast<std::uint8_t>(1U << k);
    }
  });
  arch_.assign(continued_.size(), 0);
  std::array<std::uint32_t, k_most_around> fan;
  std::array<Vec3, k_most_around> fan_normals;
  for_each([&](std::uint32_t place) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      if ((flags[clusters_.slot(place)] >> (3 + k) & 1U) != 0) continue;
      std::size_t count = 0;
      bool hollow = false;
      const bool closed = around(place, k, [&](std::uint32_t at, std::uint32_t corner) {
        const std::uint32_t slot = clusters_.slot(at);
        fan[count] = slot;
        fan_normals[count++] = normal_at(slot);
        hollow = hollow || (flags[slot] >> corner & 1U) != 0;
        flags[slot] |= static_cast<std::uint8_t>(8U << corner);
      });
      const std::span around_it(fan_normals.data(), count);
      const bool is_arch = closed && !hollow && step_of(around_it) * tallest_ < k_highest_step * tolerance_m();
      const double tilt = is_arch ? tilt_of(around_it) : 1;
      const auto code = tilt < 1 ? static_cast<std::uint16_t>(std::ceil(k_tilts * tilt)) : k_no_arch;
      for (std::size_t i = 0; i < count; ++i) arch_[fan[i]] = std::max(arch_[fan[i]], code);
    }
  });
}

}  // namespace papilla
