// SPDX-License-Identifier: MIT
#include "player/workspace.hpp"

#include <gtest/gtest.h>

#include <array>

#include "papilla/haptic/height_field.hpp"

namespace papilla::player {
namespace {

/// Two plates in the plane x = 0.2 that look along −x, a small one and one of 60 × 20 mm with a relief.
HapticScene two_plates() {
  HapticScene scene;
  scene.materials.resize(2);
  scene.mesh.positions = {{0.2, 0, 0},      {0.2, 0, 0.01},    {0.2, 0.01, 0},  {0.2, 0.1, 0.3},
                          {0.2, 0.1, 0.36}, {0.2, 0.12, 0.36}, {0.2, 0.12, 0.3}};
  scene.mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {3, 5, 6}};
  scene.mesh.material = {0, 1, 1};
  return scene;
}

TEST(Workspace, LiesWhereItIsAskedFor) {
  const HapticScene scene = two_plates();
  const ContactSurface surface(scene.mesh, scene.materials, {}, 0.002);
  EXPECT_EQ(workspace_origin(std::array{0.1, -0.2, 0.3}, scene, surface, "a.glb"), (Vec3{0.1, -0.2, 0.3}));
}

TEST(Workspace, LiesACentimetreAboveTheReliefOfTheLargestSurface) {
  HapticScene scene = two_plates();
  scene.mesh.corner_uv = {{0, 0}, {0, 1}, {1, 0}, {0, 0}, {3, 0}, {3, 1}, {0, 0}, {3, 1}, {0, 1}};
  scene.materials[1].height = 0;
  const HeightField relief(2, 1, {65535, 65535}, {.scale_m = 2e-4, .offset_m = 1e-4});
  const ContactSurface surface(scene.mesh, scene.materials, {relief}, 0.002);
  EXPECT_LT(norm(workspace_origin({}, scene, surface, "a.glb") - Vec3{0.2 - 0.01 - 3e-4 - 0.002, 0.11, 0.33}), 1e-6);
}

}  // namespace
}  // namespace papilla::player
