// SPDX-License-Identifier: MIT
#include "papilla/io/vertex_normals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "io/scene_fixtures.hpp"

namespace papilla {
namespace {

/// A closed cylinder around z, its caps as fans.
TriangleMesh cylinder(int sides) {
  TriangleMesh mesh;
  for (int i = 0; i < sides; ++i) {
    const double a = 2 * std::numbers::pi * i / sides;
    mesh.positions.push_back({std::cos(a), std::sin(a), 0});
    mesh.positions.push_back({std::cos(a), std::sin(a), 1});
  }
  const Index n = static_cast<Index>(sides);
  mesh.positions.push_back({0, 0, 0});
  mesh.positions.push_back({0, 0, 1});
  for (Index i = 0; i < n; ++i) {
    const Index a = 2 * i, b = 2 * ((i + 1) % n);
    mesh.triangles.push_back({a, b, b + 1});
    mesh.triangles.push_back({a, b + 1, a + 1});
    mesh.triangles.push_back({2 * n, b, a});
    mesh.triangles.push_back({2 * n + 1, a + 1, b + 1});
  }
  return mesh;
}

TEST(VertexNormals, ACubeHasSixSharpSides) {
  const TriangleMesh mesh = test::cube(2);
  const auto normals = vertex_normals(mesh);
  EXPECT_EQ(normals.values.size(), 24U) << "three at each of eight corners";
  for (std::size_t t = 0; t < 12; ++t) {
    const Vec3 flat = normalized(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
    for (const Index n : normals.indices[t]) EXPECT_NEAR(norm(normals.values[n] - flat), 0, 1e-15);
  }
}

TEST(VertexNormals, AWideCreaseSmoothsTheCube) { EXPECT_EQ(vertex_normals(test::cube(2), 91).values.size(), 8U); }

TEST(VertexNormals, ACylinderIsRoundAndItsRimsSharp) {
  const TriangleMesh mesh = cylinder(36);
  const auto normals = vertex_normals(mesh);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 n = normals.values[normals.indices[t][k]];
      const Vec3 p = mesh.positions[mesh.triangles[t][k]];
      const Vec3 exact = t % 4 == 2 ? Vec3{0, 0, -1} : t % 4 == 3 ? Vec3{0, 0, 1} : Vec3{p.x, p.y, 0};
      // At a rim vertex two triangles of one side (at 5°) meet one of the other (at −5°): the mean is off by a third.
      const double off = t % 4 < 2 ? std::atan(std::tan(5 * std::numbers::pi / 180) / 3) : 0;
      EXPECT_NEAR(dot(n, exact), std::cos(off), 1e-12);
    }
}

TEST(VertexNormals, LargeTrianglesWeighMore) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 1, 0}, {3, 0.5, 0}, {-1, 0.5, -0.2}};
  mesh.triangles = {{1, 0, 2}, {0, 1, 3}};
  const auto normals = vertex_normals(mesh);
  const Vec3 expected = normalized(Vec3{0, 0, 3} + cross(Vec3{0, 1, 0}, Vec3{-1, 0.5, -0.2}));
  EXPECT_NEAR(norm(normals.values[normals.indices[0][0]] - expected), 0, 1e-12);
  EXPECT_NEAR(norm(normals.values[normals.indices[1][1]] - expected), 0, 1e-12);
}

/// Two sheets that run along their common edge in the same direction are back to front.
TEST(VertexNormals, OpposedTrianglesStaySharp) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0.1}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
  EXPECT_EQ(vertex_normals(mesh).values.size(), 6U);
}

TEST(VertexNormals, DegenerateTrianglesGetSomeUnitNormal) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 0, 0}};
  for (const Vec3& n : vertex_normals(mesh).values) EXPECT_EQ(n, (Vec3{0, 0, 1}));
}

TEST(VertexNormals, NonManifoldEdgesStaySharp) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 1, 0.1}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  EXPECT_EQ(vertex_normals(mesh).values.size(), 9U);
}

}  // namespace
}  // namespace papilla
