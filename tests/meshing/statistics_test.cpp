// SPDX-License-Identifier: MIT
#include "papilla/meshing/statistics.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "meshing/shapes.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using namespace test;

TEST(Statistics, EmptyMesh) {
  const MeshStatistics s = mesh_statistics({});
  EXPECT_EQ(s.triangles, 0u);
  EXPECT_EQ(s.components, 0u);
  EXPECT_FALSE(s.volume_mm3.has_value());
}

TEST(Statistics, CubeAsMeshAndAsSoup) {
  for (const TriangleMesh& mesh : {cube(3), soup_of(cube(3))}) {
    const MeshStatistics s = mesh_statistics(mesh);
    EXPECT_EQ(s.triangles, 6u * 9 * 2);
    EXPECT_EQ(s.vertices, 56u);
    EXPECT_EQ(s.edges, 162u);
    EXPECT_EQ(s.components, 1u);
    EXPECT_EQ(s.boundary_loops, 0u);
    EXPECT_EQ(s.genus, 0);
    EXPECT_NEAR(s.aspect_max, 2, 1e-12);
    EXPECT_NEAR(s.area_mm2, 6, 1e-12);
    ASSERT_TRUE(s.volume_mm3.has_value());
    EXPECT_NEAR(*s.volume_mm3, 1, 1e-12);
    EXPECT_EQ(s.high, (Vec3{1, 1, 1}));
  }
}

TEST(Statistics, VolumeOfReversedMeshIsNegative) {
  EXPECT_NEAR(*mesh_statistics(reversed(cube())).volume_mm3, -1, 1e-12);
}

TEST(Statistics, GenusOfSphereTorusAndDoubleTorus) {
  EXPECT_EQ(mesh_statistics(sphere(6)).genus, 0);
  EXPECT_EQ(mesh_statistics(torus(20, 12)).genus, 1);
  EXPECT_EQ(mesh_statistics(double_torus()).genus, 2);
  EXPECT_EQ(mesh_statistics(joined(torus(20, 12), moved(double_torus(), {9, 9, 9}))).genus, 3);
}

TEST(Statistics, BorderLoops) {
  EXPECT_EQ(mesh_statistics(grid(4, 3)).boundary_loops, 1u);
  EXPECT_EQ(mesh_statistics(grid(4, 3)).boundary_edges, 14u);
  EXPECT_EQ(mesh_statistics(tube(12, 4)).boundary_loops, 2u);
  EXPECT_EQ(mesh_statistics(tube(12, 4)).genus, 0);
}

TEST(Statistics, MoebiusHasHalfAHandleAndOneFlippedStrip) {
  const MeshStatistics s = mesh_statistics(moebius(20));
  EXPECT_EQ(s.boundary_loops, 1u);
  EXPECT_EQ(s.genus, 0.5);
  EXPECT_EQ(s.flipped_edges, 1u);
}

TEST(Statistics, DuplicatesCountWhateverTheirSense) {
  TriangleMesh mesh = grid(2, 2);
  mesh.triangles.push_back(mesh.triangles[0]);
  mesh.triangles.push_back({mesh.triangles[1][1], mesh.triangles[1][0], mesh.triangles[1][2]});
  const MeshStatistics s = mesh_statistics(mesh);
  EXPECT_EQ(s.duplicate_triangles, 2u);
  EXPECT_GT(s.nonmanifold_edges, 0u);
}

TEST(Statistics, OneReversedTriangleFlipsItsInnerEdges) {
  TriangleMesh mesh = cube(2);
  std::swap(mesh.triangles[5][0], mesh.triangles[5][1]);
  EXPECT_EQ(mesh_statistics(mesh).flipped_edges, 3u);
  EXPECT_FALSE(mesh_statistics(mesh).volume_mm3.has_value()) << "it has no inside";
}

TEST(Statistics, TJunctionOfHalfEdge) {
  TriangleMesh mesh;  // a square above one long edge, two triangles below that edge meeting in its middle
  mesh.positions = {{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0.5, -1, 0}, {1.5, -1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 4, 3}, {3, 5, 1}};
  EXPECT_EQ(mesh_statistics(mesh).t_junctions, 1u);
  mesh.positions[3].y = 1e-3;
  EXPECT_EQ(mesh_statistics(mesh).t_junctions, 0u);
  for (const double end : {0.0, 2.0}) {  // A crack beside an end of the long edge.
    mesh.positions[3] = {end + (end > 0 ? -1e-9 : 1e-9), 0, 0};
    EXPECT_EQ(mesh_statistics(mesh).t_junctions, 0u) << end;
  }
}

TEST(Statistics, DegenerateByRepeatedCornerAndByAltitude) {
  TriangleMesh mesh = grid(2, 2);
  mesh.triangles.push_back({0, 0, 1});
  mesh.positions.push_back({0.5, 1e-8, 5});
  mesh.positions.push_back({1.5, 0, 5});
  mesh.positions.push_back({2, 0, 5});
  mesh.triangles.push_back({9, 10, 11});
  const MeshStatistics s = mesh_statistics(mesh);
  EXPECT_EQ(s.degenerate_triangles, 2u);
  EXPECT_LT(s.aspect_max, 10);
}

/// The altitude on the hypotenuse of 5 is 2.4, with whichever corner a triangle begins.
TEST(Statistics, AspectIsThatOfTheLongestEdge) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 3, 0}, {0, 0, 4}};
  for (const Triangle& t : {Triangle{0, 1, 2}, Triangle{1, 2, 0}, Triangle{2, 0, 1}, Triangle{2, 1, 0}}) {
    mesh.triangles = {t};
    EXPECT_NEAR(mesh_statistics(mesh).aspect_max, 5 / 2.4, 1e-12);
  }
}

TEST(Statistics, ScalesWithTheObject) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    TriangleMesh mesh = torus(20, 12);
    for (Vec3& p : mesh.positions) p = scale * p;
    const MeshStatistics s = mesh_statistics(mesh);
    EXPECT_EQ(s.degenerate_triangles, 0u);
    EXPECT_EQ(s.genus, 1);
  }
}

TEST(Statistics, NegativeZeroIsZero) {
  TriangleMesh mesh = soup_of(grid(1, 1));
  mesh.positions[0].x = -0.0;
  EXPECT_EQ(mesh_statistics(mesh).vertices, 4u);
}

TEST(Statistics, RefusesBadInput) {
  TriangleMesh out_of_range = cube();
  out_of_range.triangles[3][1] = 99;
  EXPECT_THROW(mesh_statistics(out_of_range), InvalidInput);
  TriangleMesh not_finite = cube();
  not_finite.positions[2].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(mesh_statistics(not_finite), InvalidInput);
}

}  // namespace
}  // namespace papilla
