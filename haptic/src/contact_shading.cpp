// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>

#include "contact_triangles.hpp"

namespace papilla {
namespace {

constexpr int k_most_faces = 16;   // Touched at once; more add nothing to a normal.
constexpr int k_rounds = 64;       // Of coordinate descent.
constexpr double k_steps = 32767;  // Half the side of the unfolded octahedron.

double side_of(double v) noexcept { return v < 0 ? -1 : 1; }

/// argmin |normal − Σ λ f|² with λ ≥ 0, by coordinate descent (Hildreth).
void fit_weights(Vec3 normal, const std::array<Vec3, k_most_faces>& faces, int count,
                 std::array<double, k_most_faces>& weight) noexcept {
  Vec3 left = normal;
  for (int round = 0; round < k_rounds; ++round)
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      const double next = std::max(0.0, weight[i] + dot(left, faces[i]));
      left = left - (next - weight[i]) * faces[i];
      weight[i] = next;
    }
}

}  // namespace

ContactTriangles::PackedNormal ContactTriangles::packed(Vec3 n) noexcept {
  const double size = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  if (!(size > 0)) return {};
  double u = n.x / size, v = n.y / size;
  if (n.z < 0) {
    const double folded = (1 - std::abs(v)) * side_of(u);
    v = (1 - std::abs(u)) * side_of(v);
    u = folded;
  }
  return {static_cast<std::int16_t>(std::lround(k_steps * u)), static_cast<std::int16_t>(std::lround(k_steps * v))};
}

Vec3 ContactTriangles::unpacked(PackedNormal n) noexcept {
  Vec3 v{n[0] / k_steps, n[1] / k_steps, 0};
  v.z = 1 - std::abs(v.x) - std::abs(v.y);
  if (v.z < 0) v = {(1 - std::abs(v.y)) * side_of(v.x), (1 - std::abs(v.x)) * side_of(v.y), v.z};
  return normalized(v);
}

Vec3 ContactTriangles::shaded_normal(Vec3 proxy, Vec3 normal) const noexcept {
  if (normals_.empty()) return normal;
  const Vec3 x = proxy - origin_;
  std::array<Vec3, k_most_faces> faces, shades;
  int count = 0;
  bool plain = false;
  double reach = contact_radius_m() + 2 * tolerance_m();
  const Box3f box = box_around(x, x, reach);
  clusters_.within(x, reach, [&](std::uint32_t cluster) noexcept {
    clusters_.in_box(cluster, box, [&](std::uint32_t place) noexcept {
      const Corners t = corners(place);
      const Foot f = foot(t, x);
      if (count == k_most_faces || norm(x - f.point) > reach) return;
      plain = plain || has_relief(place) || !materials_[material_of(place)].shading;
      const Vec3 face = normalized(cross(t.b - t.a, t.c - t.a));
      const double side = side_of(dot(face, normal));
      const auto at = static_cast<std::size_t>(count++);
      const auto& n = normals_[clusters_.slot(place)];
      faces[at] = side * face;
      shades[at] = side * normalized((1 - f.v - f.w) * unpacked(n[0]) + f.v * unpacked(n[1]) + f.w * unpacked(n[2]));
    });
  });
  if (plain || count == 0) return normal;
  std::array<double, k_most_faces> weight{};
  fit_weights(normal, faces, count, weight);
  Vec3 sum;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) sum = sum + weight[i] * shades[i];
  return norm(sum) > 0 ? normalized(sum) : normal;
}

}  // namespace papilla
