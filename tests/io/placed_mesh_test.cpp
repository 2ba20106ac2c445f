// SPDX-License-Identifier: MIT
#include "placed_mesh.hpp"

#include <gtest/gtest.h>

#include "io/scene_fixtures.hpp"

namespace papilla {
namespace {

/// An oblique triangle with its own normal, turned about all axes, scaled unevenly and mirrored: the normal is that of
/// the triangle as it is to be written.
TEST(PlacedMesh, NormalsStayUprightOnTheSideThatIsSeen) {
  Scene scene = test::rich_scene();
  TriangleMesh& mesh = scene.parts[0].mesh;
  mesh = {};
  mesh.positions = {{10, 20, 30}, {50, 10, 40}, {20, 70, 10}};
  mesh.triangles = {{0, 1, 2}};
  mesh.normals.values = {
      normalized(cross(mesh.positions[1] - mesh.positions[0], mesh.positions[2] - mesh.positions[0]))};
  mesh.normals.indices = {{0, 0, 0}};
  for (const double side : {1.0, -1.0}) {
    Instance instance = instances(scene)[0];
    // 2, 3 and 5 along axes turned by the quaternion (0.1, -0.5, 0.7, 0.5).
    instance.world = {side * 2 * -0.48, 3 * -0.8, 5 * -0.36, 7,  //
                      side * 2 * 0.6,   3 * 0,    5 * -0.8,  8,  //
                      side * 2 * 0.64,  3 * -0.6, 5 * 0.48,  9, 0, 0, 0, 1};
    const PlacedMesh placed = place(scene, instance);
    EXPECT_EQ(placed.mirrored, side < 0);
    const auto order = corner_order(placed);
    const Vec3 a = placed.positions[order[0]], b = placed.positions[order[1]], c = placed.positions[order[2]];
    EXPECT_LT(norm(placed.normals[0] - normalized(cross(b - a, c - a))), 1e-12) << side;
  }
}

}  // namespace
}  // namespace papilla
