// SPDX-License-Identifier: MIT
#include "papilla_test/shapes.hpp"

#include <cmath>
#include <initializer_list>
#include <numbers>
#include <string>

#include "papilla/core/error.hpp"

namespace papilla::test {
namespace {

using std::numbers::pi;

void require_lengths(const char* function, std::initializer_list<double> lengths) {
  for (const double length : lengths)
    if (!std::isfinite(length) || length <= 0)
      throw InvalidInput(std::string(function) + ": length " + std::to_string(length) + " is not positive and finite");
}

void require_at_least(const char* function, Index count, Index minimum) {
  if (count < minimum)
    throw InvalidInput(std::string(function) + ": subdivision " + std::to_string(count) + " is below " +
                       std::to_string(minimum));
}

/// Two triangles for the quad a b c d, counter-clockwise.
void add_quad(TriangleMesh& mesh, Index a, Index b, Index c, Index d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

/// The direction of step i of n around the z axis; the same bits for i = 0 and i = n.
Vec3 direction(Index i, Index n) {
  const double angle = 2 * pi * (i % n) / n;
  return {std::cos(angle), std::sin(angle), 0};
}

/// uv = (x, y) of every corner.
void project_uv(TriangleMesh& mesh) {
  for (const Vec3& p : mesh.positions) mesh.uv.values.push_back({p.x, p.y});
  mesh.uv.indices = mesh.triangles;
}

/// A disc of rings around vertex 0; `place(distance, direction)` with distance in [0, 1] gives the position.
template <class Place>
TriangleMesh polar_grid(Index rings, Index segments, const Place& place) {
  TriangleMesh mesh;
  mesh.positions.push_back(place(0.0, Vec3{1, 0, 0}));
  for (Index ring = 1; ring <= rings; ++ring)
    for (Index i = 0; i < segments; ++i)
      mesh.positions.push_back(place(static_cast<double>(ring) / rings, direction(i, segments)));
  const auto at = [&](Index ring, Index i) { return 1 + (ring - 1) * segments + i % segments; };
  for (Index i = 0; i < segments; ++i) mesh.triangles.push_back({0, at(1, i), at(1, i + 1)});
  for (Index ring = 1; ring < rings; ++ring)
    for (Index i = 0; i < segments; ++i)
      add_quad(mesh, at(ring, i), at(ring + 1, i), at(ring + 1, i + 1), at(ring, i + 1));
  return mesh;
}

}  // namespace

TriangleMesh cube(double edge_mm) {
  require_lengths("cube", {edge_mm});
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.push_back({edge_mm * (i & 1), edge_mm * (i >> 1 & 1), edge_mm * (i >> 2)});
  add_quad(mesh, 0, 2, 3, 1);
  add_quad(mesh, 4, 5, 7, 6);
  add_quad(mesh, 0, 1, 5, 4);
  add_quad(mesh, 2, 6, 7, 3);
  add_quad(mesh, 0, 4, 6, 2);
  add_quad(mesh, 1, 3, 7, 5);
  return mesh;
}

TriangleMesh plane(double width_mm, double height_mm, Index columns, Index rows) {
  require_lengths("plane", {width_mm, height_mm});
  require_at_least("plane", columns, 1);
  require_at_least("plane", rows, 1);
  TriangleMesh mesh;
  for (Index row = 0; row <= rows; ++row)
    for (Index column = 0; column <= columns; ++column)
      mesh.positions.push_back({width_mm * column / columns, height_mm * row / rows, 0});
  const auto at = [&](Index column, Index row) { return row * (columns + 1) + column; };
  for (Index row = 0; row < rows; ++row)
    for (Index column = 0; column < columns; ++column)
      add_quad(mesh, at(column, row), at(column + 1, row), at(column + 1, row + 1), at(column, row + 1));
  project_uv(mesh);
  return mesh;
}

TriangleMesh uv_sphere(double radius_mm, Index rings, Index segments) {
  require_lengths("uv_sphere", {radius_mm});
  require_at_least("uv_sphere", rings, 2);
  require_at_least("uv_sphere", segments, 3);
  TriangleMesh mesh;
  mesh.positions.push_back({0, 0, radius_mm});
  for (Index ring = 1; ring < rings; ++ring) {
    const double angle = pi * ring / rings;
    for (Index i = 0; i < segments; ++i)
      mesh.positions.push_back(radius_mm * (std::sin(angle) * direction(i, segments) + Vec3{0, 0, std::cos(angle)}));
  }
  mesh.positions.push_back({0, 0, -radius_mm});
  const auto south = static_cast<Index>(mesh.positions.size() - 1);
  const auto at = [&](Index ring, Index i) { return 1 + (ring - 1) * segments + i % segments; };
  for (Index i = 0; i < segments; ++i) {
    mesh.triangles.push_back({0, at(1, i), at(1, i + 1)});
    for (Index ring = 1; ring + 1 < rings; ++ring)
      add_quad(mesh, at(ring, i), at(ring + 1, i), at(ring + 1, i + 1), at(ring, i + 1));
    mesh.triangles.push_back({south, at(rings - 1, i + 1), at(rings - 1, i)});
  }
  return mesh;
}

TriangleMesh torus(double major_mm, double minor_mm, Index segments, Index sides) {
  require_lengths("torus", {major_mm, minor_mm, major_mm - minor_mm});
  require_at_least("torus", segments, 3);
  require_at_least("torus", sides, 3);
  TriangleMesh mesh;
  for (Index i = 0; i < segments; ++i)
    for (Index j = 0; j < sides; ++j) {
      const Vec3 tube = minor_mm * direction(j, sides);
      mesh.positions.push_back((major_mm + tube.x) * direction(i, segments) + Vec3{0, 0, tube.y});
    }
  const auto at = [&](Index i, Index j) { return i % segments * sides + j % sides; };
  for (Index i = 0; i < segments; ++i)
    for (Index j = 0; j < sides; ++j) add_quad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  return mesh;
}

TriangleMesh cylinder(double radius_mm, double height_mm, Index segments, Index rows) {
  require_lengths("cylinder", {radius_mm, height_mm});
  require_at_least("cylinder", segments, 3);
  require_at_least("cylinder", rows, 1);
  // The flat pattern rolled up: its last column becomes the first.
  const double chord = 2 * radius_mm * std::sin(pi / segments);
  const TriangleMesh flat = plane(chord * segments, height_mm, segments, rows);
  const auto wrapped = [&](Index i) { return i / (segments + 1) * segments + i % (segments + 1) % segments; };
  TriangleMesh mesh;
  mesh.uv = flat.uv;
  for (Index row = 0; row <= rows; ++row)
    for (Index i = 0; i < segments; ++i)
      mesh.positions.push_back(radius_mm * direction(i, segments) + Vec3{0, 0, height_mm * row / rows});
  for (const Triangle& t : flat.triangles) mesh.triangles.push_back({wrapped(t[0]), wrapped(t[1]), wrapped(t[2])});
  return mesh;
}

TriangleMesh cone(double radius_mm, double height_mm, Index segments) {
  require_lengths("cone", {radius_mm, height_mm});
  require_at_least("cone", segments, 3);
  return polar_grid(1, segments, [&](double distance, Vec3 d) {
    return distance * radius_mm * d + Vec3{0, 0, (1 - distance) * height_mm};
  });
}

TriangleMesh moebius_strip(double radius_mm, double width_mm, Index segments, Index rows) {
  require_lengths("moebius_strip", {radius_mm, width_mm, 2 * radius_mm - width_mm});
  require_at_least("moebius_strip", segments, 3);
  require_at_least("moebius_strip", rows, 1);
  TriangleMesh mesh;
  for (Index i = 0; i < segments; ++i)
    for (Index j = 0; j <= rows; ++j) {
      const double half_turn = pi * i / segments;
      const double across = width_mm * (static_cast<double>(j) / rows - 0.5);
      mesh.positions.push_back((radius_mm + across * std::cos(half_turn)) * direction(i, segments) +
                               Vec3{0, 0, across * std::sin(half_turn)});
    }
  // After one turn the strip meets its start upside down.
  const auto at = [&](Index i, Index j) { return i < segments ? i * (rows + 1) + j : rows - j; };
  for (Index i = 0; i < segments; ++i)
    for (Index j = 0; j < rows; ++j) add_quad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  return mesh;
}

TriangleMesh saddle(double radius_mm, double curvature_radius_mm, Index rings, Index segments) {
  require_lengths("saddle", {radius_mm, curvature_radius_mm});
  require_at_least("saddle", rings, 1);
  require_at_least("saddle", segments, 3);
  return polar_grid(rings, segments, [&](double distance, Vec3 d) {
    const Vec3 p = distance * radius_mm * d;
    return Vec3{p.x, p.y, (p.x * p.x - p.y * p.y) / (2 * curvature_radius_mm)};
  });
}

TriangleMesh spherical_cap(double radius_mm, double half_angle_rad, Index rings, Index segments) {
  require_lengths("spherical_cap", {radius_mm, half_angle_rad, pi - half_angle_rad});
  require_at_least("spherical_cap", rings, 1);
  require_at_least("spherical_cap", segments, 3);
  return polar_grid(rings, segments, [&](double distance, Vec3 d) {
    const double angle = distance * half_angle_rad;
    return radius_mm * (std::sin(angle) * d + Vec3{0, 0, std::cos(angle)});
  });
}

TriangleMesh needle_strip(double length_mm, double width_mm, Index count) {
  require_lengths("needle_strip", {length_mm, width_mm});
  require_at_least("needle_strip", count, 1);
  return plane(length_mm, width_mm, 1, count);
}

double surface_area(const TriangleMesh& mesh) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    area += norm(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0))) / 2;
  return area;
}

double enclosed_volume(const TriangleMesh& mesh) {
  double volume = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    volume += dot(mesh.corner(t, 0), cross(mesh.corner(t, 1), mesh.corner(t, 2))) / 6;
  return volume;
}

}  // namespace papilla::test
