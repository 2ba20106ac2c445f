// SPDX-License-Identifier: MIT
#include "evaluate/extreme_meshes.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace papilla {
namespace {

constexpr int k_cells = 40;
constexpr double k_side_mm = 100;

/// Samples point(s, t) over the unit square on n × m quads of two triangles, with (s, t) as CAD parameters.
template <class Point>
TriangleMesh patch(int n, int m, Point&& point) {
  TriangleMesh mesh;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i) {
      const Vec2 st{static_cast<double>(i) / n, static_cast<double>(j) / m};
      mesh.positions.push_back(point(st.x, st.y));
      mesh.cad_uv.values.push_back(st);
    }
  const auto at = [&](int i, int j) { return static_cast<Index>(j * (n + 1) + i); };
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  mesh.cad_uv.indices = mesh.triangles;
  mesh.face.assign(mesh.triangles.size(), 0);
  return mesh;
}

Vec3 dome(double s, double t) {
  const double bulge = s * (1 - s) * t * (1 - t);
  return {k_side_mm * s, k_side_mm * t, 2 * k_side_mm * bulge};
}

TriangleMesh dome_mesh(int n) { return patch(n, n, dome); }

TriangleMesh scaled(TriangleMesh mesh, Vec3 by) {
  for (Vec3& p : mesh.positions) p = {p.x * by.x, p.y * by.y, p.z * by.z};
  return mesh;
}

TriangleMesh scaled(double by) { return scaled(dome_mesh(k_cells), {by, by, by}); }

/// The dome scaled along x so that its triangles have this aspect ratio.
TriangleMesh needles(double aspect) { return scaled(dome_mesh(k_cells), {1 / aspect, 1, 1}); }

/// The scale at which a triangle of the dome has this area.
double scale_to_area(double area_mm2) {
  const double side = k_side_mm / k_cells;
  return std::sqrt(2 * area_mm2) / side;
}

TriangleMesh moved(Vec3 by) {
  TriangleMesh mesh = dome_mesh(k_cells);
  for (Vec3& p : mesh.positions) p = p + by;
  return mesh;
}

/// Some inner vertices are moved towards a neighbour by `share` of the edge.
TriangleMesh squashed(double share) {
  TriangleMesh mesh = dome_mesh(k_cells);
  constexpr int row = k_cells + 1;
  for (int j = 2; j < k_cells - 1; j += 3)
    for (int i = 3; i < k_cells - 2; i += 7) {
      const auto v = static_cast<std::size_t>(j * row + i);
      mesh.positions[v] = mesh.positions[v] + share * (mesh.positions[v + 1] - mesh.positions[v]);
    }
  return mesh;
}

/// Some triangles have collinear corners: a vertex is moved to the midpoint of the opposite edge.
TriangleMesh collinear() {
  TriangleMesh mesh = dome_mesh(k_cells);
  constexpr int row = k_cells + 1;
  for (int j = 2; j < k_cells - 1; j += 4)
    for (int i = 3; i < k_cells - 2; i += 4) {
      const auto v = static_cast<std::size_t>(j * row + i);
      mesh.positions[v] = 0.5 * (mesh.positions[v - 1] + mesh.positions[v + row]);
    }
  return mesh;
}

/// A sphere without a polar cap of 3 degrees.
TriangleMesh nearly_closed_sphere() {
  TriangleMesh mesh;
  constexpr int around = 64, up = 48;
  const double from = 3 * std::numbers::pi / 180;
  for (int j = 0; j < up; ++j)
    for (int i = 0; i < around; ++i) {
      const double a = 2 * std::numbers::pi * i / around, b = from + (std::numbers::pi - from) * j / up;
      mesh.positions.push_back(50.0 * Vec3{std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), std::cos(b)});
    }
  mesh.positions.push_back({0, 0, -50});
  const auto at = [&](int i, int j) { return static_cast<Index>(j * around + i % around); };
  for (int j = 0; j + 1 < up; ++j)
    for (int i = 0; i < around; ++i) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  for (int i = 0; i < around; ++i)
    mesh.triangles.push_back({at(i, up - 1), static_cast<Index>(mesh.positions.size() - 1), at(i + 1, up - 1)});
  return mesh;
}

/// A tube 30 radii long with one closed end.
TriangleMesh finger() {
  TriangleMesh mesh;
  constexpr int around = 32, along = 120;
  constexpr double radius = 5, length = 30 * radius;
  for (int j = 0; j < along; ++j) {
    const double z = length * j / along, left = length - z;
    const double r =
        left < radius ? std::sqrt(std::max(0.0, radius * radius - (radius - left) * (radius - left))) : radius;
    for (int i = 0; i < around; ++i) {
      const double a = 2 * std::numbers::pi * i / around;
      mesh.positions.push_back({r * std::cos(a), r * std::sin(a), z});
    }
  }
  mesh.positions.push_back({0, 0, length});
  const auto at = [&](int i, int j) { return static_cast<Index>(j * around + i % around); };
  for (int j = 0; j + 1 < along; ++j)
    for (int i = 0; i < around; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  for (int i = 0; i < around; ++i)
    mesh.triangles.push_back({at(i, along - 1), at(i + 1, along - 1), static_cast<Index>(mesh.positions.size() - 1)});
  return mesh;
}

TriangleMesh one_triangle() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {10, 0, 0}, {0, 10, 5}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

}  // namespace

std::vector<NamedMesh> extreme_meshes() {
  std::vector<NamedMesh> meshes;
  meshes.push_back({"dome, nothing extreme", dome_mesh(k_cells)});
  meshes.push_back({"needles, aspect 1e3", needles(1e3)});
  meshes.push_back({"needles, aspect 1e5", needles(1e5)});
  meshes.push_back({"needles, aspect 1e7", needles(1e7)});
  meshes.push_back({"triangles of 1e-20 mm²", scaled(scale_to_area(1e-20))});
  meshes.push_back({"triangles of 1e20 mm²", scaled(scale_to_area(1e20))});
  meshes.push_back({"scaled by 1e-9", scaled(1e-9)});
  meshes.push_back({"scaled by 1e9", scaled(1e9)});
  meshes.push_back({"1e6 mm off the origin", moved({1e6, -1e6, 1e6})});
  meshes.push_back({"squashed to 1e-9 of an edge", squashed(1 - 1e-9)});
  meshes.push_back({"vertices on top of each other", squashed(1)});
  meshes.push_back({"corners on a line", collinear()});
  meshes.push_back({"one triangle", one_triangle()});
  meshes.push_back({"sphere, a 3 degree hole", nearly_closed_sphere()});
  meshes.push_back({"finger, 30 radii long", finger()});
  meshes.push_back({"a million triangles", dome_mesh(708)});
  return meshes;
}

}  // namespace papilla
