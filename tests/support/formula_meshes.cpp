// SPDX-License-Identifier: MIT
#include "support/formula_meshes.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace papilla::test {
namespace {

constexpr double k_pi = std::numbers::pi;

double uniform(std::mt19937& generator) {  // [-1, 1), the same on every platform
  return static_cast<double>(generator()) / 2147483648.0 - 1;
}

}  // namespace

TriangleMesh grid_mesh(int columns, int rows, const Surface& surface, double jitter) {
  TriangleMesh mesh;
  std::mt19937 generator(1);
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      double s = static_cast<double>(i) / columns, t = static_cast<double>(j) / rows;
      const double a = uniform(generator), b = uniform(generator);
      if (i > 0 && i < columns) s += jitter * a / columns;
      if (j > 0 && j < rows) t += jitter * b / rows;
      mesh.positions.push_back(surface(s, t));
    }
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const Index a = static_cast<Index>(j * (columns + 1) + i), b = a + 1, d = a + static_cast<Index>(columns) + 1,
                  c = d + 1;
      const Vec3 ac = mesh.positions[c] - mesh.positions[a], bd = mesh.positions[d] - mesh.positions[b];
      if (dot(ac, ac) <= dot(bd, bd))
        mesh.triangles.insert(mesh.triangles.end(), {Triangle{a, b, c}, Triangle{a, c, d}});
      else
        mesh.triangles.insert(mesh.triangles.end(), {Triangle{a, b, d}, Triangle{b, c, d}});
    }
  return mesh;
}

Vec3 dashboard(double s, double t) {
  const double x = 1.4 * s, y = 0.5 * t;
  const auto bump = [&](double cx, double cy, double width, double depth) {
    const double a = (x - cx) / width, b = (y - cy) / depth;
    return std::exp(-0.5 * (a * a + b * b));
  };
  const double z = 0.10 * std::sin(k_pi * s) * std::sin(0.5 * k_pi * t + 0.3) + 0.12 * bump(0.35, 0.25, 0.12, 0.10) -
                   0.06 * bump(0.75, 0.15, 0.08, 0.12) + 0.05 * bump(1.15, 0.3, 0.15, 0.07) +
                   0.02 * std::sin(9 * s * k_pi) * std::sin(3 * t * k_pi);
  return 1000.0 * Vec3{x, y, z};
}

Vec3 open_cylinder(double s, double t) {
  return {500 * std::cos(2 * k_pi * s), 500 * std::sin(2 * k_pi * s), 2000 * t};
}

Vec3 grab_handle(double s, double t) {
  const double arc = 0.3 * k_pi, l = t * (2 + arc);
  double x = 0.3, z = 1 - (l - 1 - arc), tx = 0, tz = -1;
  if (l < 1) {
    x = -0.3, z = l, tz = 1;
  } else if (l < 1 + arc) {
    const double a = (l - 1) / 0.3;
    x = -0.3 * std::cos(a), z = 1 + 0.3 * std::sin(a), tx = std::sin(a), tz = std::cos(a);
  }
  const double r = 0.12 * (1 + 0.125 * std::sin(2 * k_pi * t) + 0.175 * std::cos(4 * k_pi * t)), a = 2 * k_pi * s;
  return 1000.0 * Vec3{x + r * std::cos(a) * tz, r * std::sin(a), z - r * std::cos(a) * tx};
}

Vec3 helical_ramp(double s, double t) {
  const double angle = 5 * k_pi * s, r = 100 + 100 * t;
  return {r * std::cos(angle), -r * std::sin(angle), -40 * angle};
}

TriangleMesh dashboard_mesh(int columns, int rows) { return grid_mesh(columns, rows, dashboard, 0.15); }

TriangleMesh sphere_mesh(int rings, int segments, double last, const std::function<double(Vec3)>& radius) {
  TriangleMesh mesh;
  const auto add = [&](Vec3 direction) { mesh.positions.push_back(radius(direction) * direction); };
  add({0, 0, 1});
  for (int r = 1; r <= rings; ++r)
    for (int s = 0; s < segments; ++s) {
      const double latitude = last * r / rings, longitude = 2 * k_pi * s / segments;
      add({std::sin(latitude) * std::cos(longitude), std::sin(latitude) * std::sin(longitude), std::cos(latitude)});
    }
  const auto vertex = [&](int r, int s) { return static_cast<Index>(1 + (r - 1) * segments + s % segments); };
  for (int s = 0; s < segments; ++s) mesh.triangles.push_back({0, vertex(1, s), vertex(1, s + 1)});
  for (int r = 1; r < rings; ++r)
    for (int s = 0; s < segments; ++s) {
      mesh.triangles.push_back({vertex(r, s), vertex(r + 1, s), vertex(r + 1, s + 1)});
      mesh.triangles.push_back({vertex(r, s), vertex(r + 1, s + 1), vertex(r, s + 1)});
    }
  return mesh;
}

TriangleMesh hemisphere_mesh(int rings, int segments, double radius) {
  return sphere_mesh(rings, segments, 0.5 * k_pi, [radius](Vec3) { return radius; });
}

ChartSet one_chart(const TriangleMesh& mesh) {
  return {std::vector<std::uint32_t>(mesh.triangles.size(), 0), mesh.triangles.empty() ? 0u : 1u, 0};
}

CornerAttribute<Vec2> uv_per_vertex(const TriangleMesh& mesh, const std::function<Vec2(Vec3)>& map) {
  CornerAttribute<Vec2> uv;
  for (const Vec3& p : mesh.positions) uv.values.push_back(map(p));
  uv.indices = mesh.triangles;
  return uv;
}

}  // namespace papilla::test
