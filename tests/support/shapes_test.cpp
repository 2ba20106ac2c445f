// SPDX-License-Identifier: MIT
#include "papilla_test/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "papilla/core/error.hpp"

namespace papilla::test {
namespace {

using std::numbers::pi;

struct Topology {
  int euler = 0, boundary_edges = 0, boundary_loops = 0, same_direction_edges = 0, crowded_edges = 0;
};

/// Counted from the halfedges alone.
Topology topology(const TriangleMesh& mesh) {
  std::map<std::pair<Index, Index>, int> halfedges;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++halfedges[{t[k], t[(k + 1) % 3]}];
  const auto count = [&](Index a, Index b) {
    const auto found = halfedges.find({a, b});
    return found == halfedges.end() ? 0 : found->second;
  };
  Topology result;
  std::vector<Index> loop_of(mesh.positions.size());
  std::iota(loop_of.begin(), loop_of.end(), 0);
  const auto root = [&](Index v) {
    while (loop_of[v] != v) v = loop_of[v];
    return v;
  };
  int edges = 0;
  for (const auto& [edge, forward] : halfedges) {
    const int backward = count(edge.second, edge.first);
    if (backward > 0 && edge.first > edge.second) continue;
    ++edges;
    result.crowded_edges += forward + backward > 2;
    result.same_direction_edges += (forward == 2 && backward == 0);
    if (forward + backward != 1) continue;
    ++result.boundary_edges;
    const Index a = root(edge.first), b = root(edge.second);
    if (a == b) ++result.boundary_loops;
    loop_of[a] = b;
  }
  result.euler = static_cast<int>(mesh.positions.size()) - edges + static_cast<int>(mesh.triangles.size());
  return result;
}

void expect_closed(const TriangleMesh& mesh, int genus) {
  const Topology t = topology(mesh);
  EXPECT_EQ(t.euler, 2 - 2 * genus);
  EXPECT_EQ(t.boundary_edges, 0);
  EXPECT_EQ(t.same_direction_edges, 0);
  EXPECT_EQ(t.crowded_edges, 0);
  EXPECT_GT(enclosed_volume(mesh), 0) << "normals point inwards";
}

void expect_open(const TriangleMesh& mesh, int boundary_loops, int euler) {
  const Topology t = topology(mesh);
  EXPECT_EQ(t.euler, euler);
  EXPECT_EQ(t.boundary_loops, boundary_loops);
  EXPECT_EQ(t.same_direction_edges, 0);
  EXPECT_EQ(t.crowded_edges, 0);
}

double smallest_area(const TriangleMesh& mesh) {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    TriangleMesh one;
    one.positions = {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
    one.triangles = {{0, 1, 2}};
    smallest = std::min(smallest, surface_area(one));
  }
  return smallest;
}

void expect_isometric_uv(const TriangleMesh& mesh) {
  ASSERT_EQ(mesh.uv.indices.size(), mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto next = (k + 1) % 3;
      const double in_space = norm(mesh.corner(t, static_cast<int>(next)) - mesh.corner(t, static_cast<int>(k)));
      const double in_uv = norm(mesh.uv.values[mesh.uv.indices[t][next]] - mesh.uv.values[mesh.uv.indices[t][k]]);
      ASSERT_NEAR(in_uv, in_space, 1e-12 * in_space);
    }
}

TEST(Shapes, Cube) {
  const TriangleMesh mesh = cube(2.5);
  expect_closed(mesh, 0);
  EXPECT_EQ(mesh.triangles.size(), 12U);
  EXPECT_DOUBLE_EQ(surface_area(mesh), 6 * 2.5 * 2.5);
  EXPECT_DOUBLE_EQ(enclosed_volume(mesh), 2.5 * 2.5 * 2.5);
}

TEST(Shapes, Plane) {
  const TriangleMesh mesh = plane(3, 2, 6, 5);
  expect_open(mesh, 1, 1);
  EXPECT_EQ(mesh.triangles.size(), 60U);
  EXPECT_NEAR(surface_area(mesh), 6, 1e-12);
  expect_isometric_uv(mesh);
}

TEST(Shapes, UvSphere) {
  for (const auto& [rings, segments] : {std::pair<Index, Index>{2, 3}, {5, 8}, {40, 60}}) {
    const TriangleMesh mesh = uv_sphere(7, rings, segments);
    expect_closed(mesh, 0);
    EXPECT_EQ(mesh.triangles.size(), 2 * segments * (rings - 1));
    const double volume = segments * std::sin(2 * pi / segments) / 3 * (1 + std::cos(pi / rings)) * 343;
    EXPECT_NEAR(enclosed_volume(mesh), volume, 1e-12 * volume);
  }
  EXPECT_NEAR(surface_area(uv_sphere(7, 200, 400)), 4 * pi * 49, 1e-3 * 4 * pi * 49);
}

TEST(Shapes, Torus) {
  for (const auto& [segments, sides] : {std::pair<Index, Index>{3, 3}, {17, 6}, {80, 40}}) {
    const TriangleMesh mesh = torus(5, 2, segments, sides);
    expect_closed(mesh, 1);
    EXPECT_EQ(mesh.triangles.size(), 2 * segments * sides);
    const double volume = segments * std::sin(2 * pi / segments) * 5 * sides / 2 * 4 * std::sin(2 * pi / sides);
    EXPECT_NEAR(enclosed_volume(mesh), volume, 1e-12 * volume);
  }
  EXPECT_NEAR(surface_area(torus(5, 2, 400, 200)), 4 * pi * pi * 10, 1e-3 * 4 * pi * pi * 10);
}

TEST(Shapes, Cylinder) {
  const TriangleMesh mesh = cylinder(3, 4, 9, 5);
  expect_open(mesh, 2, 0);
  EXPECT_EQ(mesh.triangles.size(), 90U);
  EXPECT_NEAR(surface_area(mesh), 2 * 9 * 3 * std::sin(pi / 9) * 4, 1e-12);
  expect_isometric_uv(mesh);
  EXPECT_GT(enclosed_volume(mesh), 0) << "normals point inwards";
}

TEST(Shapes, Cone) {
  const TriangleMesh mesh = cone(3, 4, 7);
  expect_open(mesh, 1, 1);
  EXPECT_NEAR(surface_area(mesh), 7 * 3 * std::sin(pi / 7) * std::sqrt(16 + 9 * std::pow(std::cos(pi / 7), 2)), 1e-12);
  double angles = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.corner(t, 1) - mesh.corner(t, 0), b = mesh.corner(t, 2) - mesh.corner(t, 0);
    angles += std::acos(dot(a, b) / (norm(a) * norm(b)));
  }
  EXPECT_NEAR(angles, 2 * 7 * std::asin(3 * std::sin(pi / 7) / 5), 1e-12);
  EXPECT_GT(enclosed_volume(mesh), 0) << "normals point inwards";
}

TEST(Shapes, MoebiusStrip) {
  for (const Index rows : {1U, 4U}) {
    const TriangleMesh mesh = moebius_strip(10, 4, 24, rows);
    const Topology t = topology(mesh);
    EXPECT_EQ(t.euler, 0);
    EXPECT_EQ(t.boundary_loops, 1);
    EXPECT_EQ(t.same_direction_edges, static_cast<int>(rows));
    EXPECT_EQ(t.crowded_edges, 0);
  }
}

TEST(Shapes, Saddle) {
  const double rho = 30, radius = 20;
  const double area = 2 * pi / 3 * rho * rho * (std::pow(1 + radius * radius / rho / rho, 1.5) - 1);
  expect_open(saddle(radius, rho, 6, 20), 1, 1);
  EXPECT_NEAR(surface_area(saddle(radius, rho, 100, 400)), area, 1e-3 * area);
}

TEST(Shapes, SphericalCap) {
  const double area = 2 * pi * 25 * (1 - std::cos(1.1));
  expect_open(spherical_cap(5, 1.1, 6, 20), 1, 1);
  EXPECT_NEAR(surface_area(spherical_cap(5, 1.1, 100, 400)), area, 1e-3 * area);
  EXPECT_GT(enclosed_volume(spherical_cap(5, 1.1, 6, 20)), 0) << "normals point inwards";
}

TEST(Shapes, NeedleStrip) {
  const TriangleMesh mesh = needle_strip(100, 1, 50);
  expect_open(mesh, 1, 1);
  EXPECT_EQ(mesh.triangles.size(), 100U);
  EXPECT_NEAR(surface_area(mesh), 100, 1e-11);
  EXPECT_NEAR(smallest_area(mesh), 1, 1e-12);
}

TEST(Shapes, HaveNoDegenerateTriangle) {
  for (const TriangleMesh& mesh :
       {cube(1), plane(1, 1, 3, 3), uv_sphere(1, 9, 9), torus(2, 1, 9, 9), cylinder(1, 1, 9, 3), cone(1, 1, 9),
        moebius_strip(2, 1, 9, 3), saddle(1, 1, 4, 9), spherical_cap(1, 2, 4, 9), needle_strip(1, 1, 4)})
    EXPECT_GT(smallest_area(mesh), 1e-3);
}

TEST(Shapes, RefuseBadArguments) {
  EXPECT_THROW(cube(0), InvalidInput);
  EXPECT_THROW(cube(std::numeric_limits<double>::quiet_NaN()), InvalidInput);
  EXPECT_THROW(plane(1, 1, 0, 1), InvalidInput);
  EXPECT_THROW(uv_sphere(1, 1, 3), InvalidInput);
  EXPECT_THROW(torus(1, 1, 8, 8), InvalidInput);
  EXPECT_THROW(moebius_strip(1, 2, 8, 1), InvalidInput);
  EXPECT_THROW(spherical_cap(1, pi, 3, 8), InvalidInput);
  EXPECT_THROW(needle_strip(1, -1, 3), InvalidInput);
}

}  // namespace
}  // namespace papilla::test
