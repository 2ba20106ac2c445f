// SPDX-License-Identifier: MIT
#include "maillot_energy.hpp"

#include <algorithm>

#include "adjacency.hpp"

namespace papilla::param_detail {
namespace {

/// Elements this much smaller than the largest count as zero.
constexpr double k_least = 1e-12;

struct MapEdges {
  std::array<Vec2, 3> edge;  ///< From corner k to the next one.
  double determinant;
  MapEdges(Vec2 a, Vec2 b, Vec2 c) : edge{b - a, c - b, a - c}, determinant(cross(b - a, c - a)) {}
};

/// ∂det/∂corner.
std::array<Vec2, 3> determinant_gradient(const MapEdges& m) {
  const auto turned = [](Vec2 e) { return Vec2{-e.y, e.x}; };
  return {turned(m.edge[1]), turned(m.edge[2]), turned(m.edge[0])};
}

Adjacency neighbours(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  TriangleMesh mesh;
  mesh.positions.assign(positions.begin(), positions.end());
  mesh.triangles.assign(triangles.begin(), triangles.end());
  return connect_triangles(mesh);
}

}  // namespace

MaillotEnergy::MaillotEnergy(std::span<const Vec3> positions, std::span<const Triangle> triangles, double length_weight)
    : MaillotEnergy(positions, triangles, neighbours(positions, triangles), length_weight) {}

MaillotEnergy::MaillotEnergy(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                             std::span<const Index> across, double length_weight)
    : rest_(triangles.size()) {
  double longest = 0;
  for (std::size_t t = 0; t < rest_.size(); ++t) {
    Rest& rest = rest_[t];
    const auto& [a, b, c] = triangles[t];
    rest.doubled_area = norm(cross(positions[b] - positions[a], positions[c] - positions[a]));
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 e = positions[triangles[t][(k + 1) % 3]] - positions[triangles[t][k]];
      rest.squared[k] = dot(e, e);
      longest = std::max(longest, rest.squared[k]);
    }
  }
  for (std::size_t t = 0; t < rest_.size(); ++t) {
    Rest& rest = rest_[t];
    const double own = *std::max_element(rest.squared.begin(), rest.squared.end());
    if (rest.doubled_area > k_least * own) rest.area_weight = (1 - length_weight) / rest.doubled_area;
    for (std::size_t k = 0; k < 3; ++k)
      if (rest.squared[k] > k_least * k_least * longest) {
        rest.share[k] = across[3 * t + k] == k_no_triangle ? 1 : 0.5;
        rest.length_weight[k] = length_weight * rest.share[k] / rest.squared[k];
      }
  }
}

MaillotEnergy::Sums MaillotEnergy::sums(std::span<const Triangle> triangles, std::span<const Vec2> uv) const {
  Sums sums;
  for (std::size_t t = 0; t < rest_.size(); ++t) {
    const Rest& rest = rest_[t];
    const MapEdges m(uv[triangles[t][0]], uv[triangles[t][1]], uv[triangles[t][2]]);
    const double own = *std::max_element(rest.squared.begin(), rest.squared.end());
    const double excess = m.determinant - rest.doubled_area;
    if (rest.doubled_area > k_least * own) sums.area += excess * excess / rest.doubled_area;
    for (std::size_t k = 0; k < 3; ++k) {
      if (rest.share[k] == 0) continue;
      const double longer = dot(m.edge[k], m.edge[k]) - rest.squared[k];
      sums.length += rest.share[k] * longer * longer / rest.squared[k];
      sums.squared_edges += rest.share[k] * rest.squared[k];
    }
  }
  return sums;
}

double MaillotEnergy::value(std::size_t triangle, Vec2 a, Vec2 b, Vec2 c) const {
  const Rest& rest = rest_[triangle];
  const MapEdges m(a, b, c);
  const double excess = m.determinant - rest.doubled_area;
  double energy = rest.area_weight * excess * excess;
  for (std::size_t k = 0; k < 3; ++k) {
    const double longer = dot(m.edge[k], m.edge[k]) - rest.squared[k];
    energy += rest.length_weight[k] * longer * longer;
  }
  return energy;
}

CornerGradient MaillotEnergy::gradient(std::size_t triangle, Vec2 a, Vec2 b, Vec2 c) const {
  const Rest& rest = rest_[triangle];
  const MapEdges m(a, b, c);
  CornerGradient gradient = determinant_gradient(m);
  for (Vec2& g : gradient) g = (2 * rest.area_weight * (m.determinant - rest.doubled_area)) * g;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 e = m.edge[k];
    const Vec2 by_end = (4 * rest.length_weight[k] * (dot(e, e) - rest.squared[k])) * e;
    gradient[k] = gradient[k] - by_end;
    gradient[(k + 1) % 3] = gradient[(k + 1) % 3] + by_end;
  }
  return gradient;
}

void MaillotEnergy::hessian(std::size_t triangle, Vec2 a, Vec2 b, Vec2 c, double, double* matrix) const {
  const Rest& rest = rest_[triangle];
  const MapEdges m(a, b, c);
  const auto by_corner = determinant_gradient(m);
  std::array<double, 6> row;
  for (std::size_t k = 0; k < 3; ++k) row[2 * k] = by_corner[k].x, row[2 * k + 1] = by_corner[k].y;
  for (std::size_t j = 0; j < 6; ++j)
    for (std::size_t i = 0; i < 6; ++i) matrix[6 * j + i] = 2 * rest.area_weight * row[i] * row[j];
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3;
    const Vec2 e = m.edge[k];
    const double weight = 8 * rest.length_weight[k];
    const std::array<double, 2> d{e.x, e.y};
    for (std::size_t j = 0; j < 2; ++j)
      for (std::size_t i = 0; i < 2; ++i) {
        const double entry = weight * d[i] * d[j];
        matrix[6 * (2 * k + j) + 2 * k + i] += entry;
        matrix[6 * (2 * l + j) + 2 * l + i] += entry;
        matrix[6 * (2 * k + j) + 2 * l + i] -= entry;
        matrix[6 * (2 * l + j) + 2 * k + i] -= entry;
      }
  }
}

}  // namespace papilla::param_detail
