// SPDX-License-Identifier: MIT
#include "papilla/meshing/coarsen.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "papilla/core/error.hpp"
#include "papilla/meshing/statistics.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla {
namespace {

TEST(Coarsen, VerticesAreThoseOfTheFinerMesh) {
  const TriangleMesh mesh = test::torus(30, 12, 60, 40);
  const CoarseMesh coarse = coarsen(mesh, 500);
  EXPECT_LE(coarse.mesh.triangles.size(), 500u);
  EXPECT_GT(coarse.mesh.triangles.size(), 480u);
  ASSERT_EQ(coarse.vertices.size(), coarse.mesh.positions.size());
  EXPECT_EQ(std::set<Index>(coarse.vertices.begin(), coarse.vertices.end()).size(), coarse.vertices.size());
  for (std::size_t v = 0; v < coarse.vertices.size(); ++v)
    EXPECT_EQ(norm(coarse.mesh.positions[v] - mesh.positions[coarse.vertices[v]]), 0);
}

TEST(Coarsen, TopologyStays) {
  const auto expect_same = [](const TriangleMesh& mesh, std::size_t triangles) {
    const MeshStatistics before = mesh_statistics(mesh), after = mesh_statistics(coarsen(mesh, triangles).mesh);
    EXPECT_EQ(after.components, before.components);
    EXPECT_EQ(after.boundary_loops, before.boundary_loops);
    EXPECT_EQ(after.genus, before.genus);
    EXPECT_EQ(after.nonmanifold_edges, 0u);
    EXPECT_EQ(after.flipped_edges, 0u);
  };
  expect_same(test::torus(30, 12, 60, 40), 200);
  expect_same(test::cylinder(10, 90, 60, 30), 150);
  expect_same(test::spherical_cap(50, 1.2, 20, 60), 100);
  expect_same(test::uv_sphere(4, 30, 50), 60);
}

double longest_edge(const TriangleMesh& mesh) {
  double longest = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) longest = std::max(longest, norm(mesh.corner(t, (k + 1) % 3) - mesh.corner(t, k)));
  return longest;
}

TEST(Coarsen, ASheetKeepsItsOutline) {
  const TriangleMesh coarse = coarsen(test::plane(200, 30, 25, 60), 400).mesh;
  double area = 0;
  for (std::size_t t = 0; t < coarse.triangles.size(); ++t)
    area += 0.5 * norm(cross(coarse.corner(t, 1) - coarse.corner(t, 0), coarse.corner(t, 2) - coarse.corner(t, 0)));
  EXPECT_NEAR(area, 200 * 30, 1e-6);
}

TEST(Coarsen, FlatPartsBesideABumpKeepEvenEdges) {
  // Of 400 triangles on 6000 mm² an even one has edges of 5.9 mm.
  TriangleMesh mesh = test::plane(200, 30, 120, 40);
  for (Vec3& p : mesh.positions) p.z = 9 * std::exp(-((p.x - 150) * (p.x - 150) + (p.y - 12) * (p.y - 12)) / 60);
  EXPECT_LT(longest_edge(coarsen(mesh, 400).mesh), 40);
}

TEST(Coarsen, EnoughIsLeftAlone) {
  const TriangleMesh mesh = test::plane(7, 3, 5, 4);
  for (const std::size_t triangles : {std::size_t{40}, std::size_t{1000}}) {
    const CoarseMesh same = coarsen(mesh, triangles);
    ASSERT_EQ(same.mesh.triangles.size(), mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(same.vertices[same.mesh.triangles[t][k]], mesh.triangles[t][k]);
  }
}

TEST(Coarsen, WhatIsNoMeshIsRefused) {
  TriangleMesh mesh = test::plane(7, 3, 5, 4);
  mesh.positions[3].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(coarsen(mesh, 10), InvalidInput);
  mesh = test::plane(7, 3, 5, 4);
  mesh.triangles[2][1] = 1000;
  EXPECT_THROW(coarsen(mesh, 10), InvalidInput);
}

}  // namespace
}  // namespace papilla
