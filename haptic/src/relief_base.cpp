// SPDX-License-Identifier: MIT
#include "relief_base.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace papilla {
namespace {

constexpr int k_shortenings = 8;        // Halvings before a vertex that turns triangles over stays where it is.
constexpr double k_least_cosine = 0.3;  // A face may tilt by 70 degrees before it counts as turned over.
constexpr double k_least_miter = 0.5;   // Sharp corners move at most twice the height.

Vec3 face_normal(Vec3 a, Vec3 b, Vec3 c) { return normalized(cross(b - a, c - a)); }

double angle_at(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 u = normalized(b - a), v = normalized(c - a);
  return std::acos(std::clamp(dot(u, v), -1.0, 1.0));
}

/// For each vertex, the number of the place it stands at.
std::vector<std::uint32_t> places_of(const std::vector<Vec3>& positions, std::size_t& count) {
  std::vector<std::uint32_t> order(positions.size()), place(positions.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return positions[a] < positions[b]; });
  count = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && !(positions[order[i]] == positions[order[i - 1]])) ++count;
    place[order[i]] = static_cast<std::uint32_t>(count);
  }
  if (!order.empty()) ++count;
  return place;
}

}  // namespace

ReliefBase relief_base(const ContactMesh& mesh, const std::vector<ContactMaterial>& materials,
                       const std::vector<HeightField>& heights) {
  const std::size_t n = mesh.triangles.size();
  const auto corner = [&](std::size_t t, std::size_t k) { return mesh.positions[mesh.triangles[t][k]]; };
  const auto lowest = [&](std::size_t t) {
    const auto& height = materials[mesh.material.empty() ? 0 : mesh.material[t]].height;
    return height ? std::min(0.0, heights[*height].min_m()) : 0.0;
  };
  ReliefBase base;
  base.corners.resize(3 * n);
  base.shifts.assign(3 * n, 0.0);
  for (std::size_t t = 0; t < n; ++t)
    for (std::size_t k = 0; k < 3; ++k) base.corners[3 * t + k] = corner(t, k);
  bool moves = false;
  for (std::size_t t = 0; t < n && !moves; ++t) moves = lowest(t) < 0;
  if (!moves) return base;

  std::size_t count = 0;
  const std::vector<std::uint32_t> place = places_of(mesh.positions, count);
  std::vector<Vec3> normal(count);
  std::vector<double> shift(count, 0.0), cosines(count, 0.0), weights(count, 0.0);
  for (std::size_t t = 0; t < n; ++t) {
    const Vec3 face = face_normal(corner(t, 0), corner(t, 1), corner(t, 2));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t p = place[mesh.triangles[t][k]];
      const double angle = angle_at(corner(t, k), corner(t, (k + 1) % 3), corner(t, (k + 2) % 3));
      const Vec3 given = mesh.corner_normals.empty() ? face : mesh.corner_normals[3 * t + k];
      normal[p] = normal[p] + angle * (is_finite(given) && dot(given, face) > 0 ? normalized(given) : face);
      shift[p] = std::min(shift[p], lowest(t));
    }
  }
  for (Vec3& v : normal) v = normalized(v);
  for (std::size_t t = 0; t < n; ++t) {
    const Vec3 face = face_normal(corner(t, 0), corner(t, 1), corner(t, 2));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t p = place[mesh.triangles[t][k]];
      const double angle = angle_at(corner(t, k), corner(t, (k + 1) % 3), corner(t, (k + 2) % 3));
      cosines[p] += angle * dot(face, normal[p]);
      weights[p] += angle;
    }
  }
  for (std::size_t p = 0; p < count; ++p)
    if (weights[p] > 0) normal[p] = (1 / std::clamp(cosines[p] / weights[p], k_least_miter, 1.0)) * normal[p];

  const auto moved = [&](std::size_t t, std::size_t k) {
    const std::uint32_t p = place[mesh.triangles[t][k]];
    return corner(t, k) + shift[p] * normal[p];
  };
  for (int round = 0; round <= k_shortenings; ++round) {
    std::vector<std::uint32_t> turned;
    for (std::size_t t = 0; t < n; ++t) {
      const Vec3 before = face_normal(corner(t, 0), corner(t, 1), corner(t, 2));
      if (before == Vec3{} || dot(before, face_normal(moved(t, 0), moved(t, 1), moved(t, 2))) >= k_least_cosine)
        continue;
      for (const std::uint32_t v : mesh.triangles[t]) turned.push_back(place[v]);
    }
    if (turned.empty()) break;
    std::sort(turned.begin(), turned.end());
    turned.erase(std::unique(turned.begin(), turned.end()), turned.end());
    for (const std::uint32_t p : turned) shift[p] = round == k_shortenings ? 0 : 0.5 * shift[p];
  }
  for (std::size_t t = 0; t < n; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      base.corners[3 * t + k] = moved(t, k);
      base.shifts[3 * t + k] = shift[place[mesh.triangles[t][k]]];
    }
  return base;
}

}  // namespace papilla
