// SPDX-License-Identifier: MIT
#include "support/solid_meshes.hpp"

#include <cmath>
#include <numbers>

#include "support/formula_meshes.hpp"

namespace papilla::test {
namespace {

constexpr double k_pi = std::numbers::pi;

}  // namespace

TriangleMesh panel_mesh(int columns, int rows) {
  constexpr double k_thickness = 10;
  TriangleMesh mesh = dashboard_mesh(columns, rows);
  const auto n = static_cast<Index>(mesh.positions.size());
  const std::size_t faces = mesh.triangles.size();
  for (Index v = 0; v < n; ++v) mesh.positions.push_back(mesh.positions[v] - Vec3{0, 0, k_thickness});
  for (std::size_t t = 0; t < faces; ++t) {
    const Triangle c = mesh.triangles[t];
    mesh.triangles.push_back({c[0] + n, c[2] + n, c[1] + n});
  }
  const auto wall = [&](int from, int to) {
    const auto a = static_cast<Index>(from), b = static_cast<Index>(to);
    mesh.triangles.push_back({b, a, a + n});
    mesh.triangles.push_back({b, a + n, b + n});
  };
  const int last_row = rows * (columns + 1);
  for (int i = 0; i < columns; ++i) {
    wall(i, i + 1);
    wall(last_row + i + 1, last_row + i);
  }
  for (int j = 0; j < rows; ++j) {
    const int row = j * (columns + 1), next = row + columns + 1;
    wall(next, row);
    wall(row + columns, next + columns);
  }
  return mesh;
}

TriangleMesh capped_cylinder_mesh(int segments) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 0, 2000}};
  for (int level = 0; level < 2; ++level)
    for (int s = 0; s < segments; ++s) {
      const double angle = 2 * k_pi * s / segments;
      mesh.positions.push_back({500 * std::cos(angle), 500 * std::sin(angle), 2000.0 * level});
    }
  const auto n = static_cast<Index>(segments);
  for (Index s = 0; s < n; ++s) {
    const Index a = 2 + s, b = 2 + (s + 1) % n, c = b + n, d = a + n;
    mesh.triangles.insert(mesh.triangles.end(), {Triangle{a, b, c}, {a, c, d}, {0, b, a}, {1, d, c}});
  }
  return mesh;
}

TriangleMesh torus_mesh(int around, int across) {
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double a = 2 * k_pi * i / around, b = 2 * k_pi * j / across, r = 1000 + 250 * std::cos(b);
      mesh.positions.push_back({r * std::cos(a), r * std::sin(a), 250 * std::sin(b)});
    }
  const auto vertex = [&](int i, int j) { return static_cast<Index>((i % around) * across + j % across); };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  return mesh;
}

}  // namespace papilla::test
