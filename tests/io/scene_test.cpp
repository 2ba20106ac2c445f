// SPDX-License-Identifier: MIT
#include "papilla/io/scene.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

constexpr Transform k_shift_x = {1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
constexpr Transform k_quarter_z = {0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Scene chain() {
  Scene scene;
  scene.parts.resize(1);
  scene.parts[0].name = "part";
  scene.nodes.resize(3);
  scene.nodes[0].name = "root";
  scene.nodes[0].children = {1};
  scene.nodes[0].local = k_shift_x;
  scene.nodes[1].children = {2};
  scene.nodes[1].local = k_quarter_z;
  scene.nodes[2].name = "leaf";
  scene.nodes[2].part = 0;
  scene.roots = {0};
  return scene;
}

TEST(Scene, MultipliesFromTheLeft) {
  EXPECT_EQ(transform_point(multiply(k_shift_x, k_quarter_z), {1, 0, 0}), (Vec3{5, 1, 0}));
  EXPECT_EQ(transform_point(multiply(k_quarter_z, k_shift_x), {1, 0, 0}), (Vec3{0, 6, 0}));
}

TEST(Scene, TurnsZUpToYUp) {
  const Transform turn = to_y_up(UpAxis::z);
  EXPECT_EQ(transform_point(turn, {1, 0, 0}), (Vec3{1, 0, 0}));
  EXPECT_EQ(transform_point(turn, {0, 0, 1}), (Vec3{0, 1, 0}));
  EXPECT_EQ(transform_point(turn, {0, 1, 0}), (Vec3{0, 0, -1}));
  EXPECT_EQ(to_y_up(UpAxis::y), k_identity);
}

TEST(Scene, InstancesCarryTheWorldTransform) {
  const auto all = instances(chain());
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].node, 2U);
  EXPECT_EQ(transform_point(all[0].world, {1, 0, 0}), (Vec3{5, 1, 0}));
}

TEST(Scene, NodesWithoutRootAreLeftOut) {
  Scene scene = chain();
  scene.roots.clear();
  EXPECT_TRUE(instances(scene).empty());
}

TEST(Scene, RefusesCyclesSharedNodesAndWrongNumbers) {
  Scene cycle = chain();
  cycle.nodes[2].children = {0};
  EXPECT_THROW(instances(cycle), InvalidInput);
  Scene shared = chain();
  shared.nodes[0].children = {1, 2};
  EXPECT_THROW(instances(shared), InvalidInput);
  Scene no_node = chain();
  no_node.nodes[1].children = {7};
  EXPECT_THROW(instances(no_node), InvalidInput);
  Scene no_part = chain();
  no_part.nodes[2].part = 1;
  EXPECT_THROW(instances(no_part), InvalidInput);
}

TEST(Scene, LongChainsNeedNoRecursionAndEnd) {
  Scene scene;
  scene.nodes.resize(1000000);
  for (std::uint32_t i = 0; i + 1 < scene.nodes.size(); ++i) scene.nodes[i].children = {i + 1};
  scene.roots = {0};
  EXPECT_NE(test::message_of<InvalidInput>([&] { instances(scene); }).find("1024"), std::string::npos);
}

TEST(Scene, IdsAreAssemblyPaths) {
  Scene scene = chain();
  scene.parts.resize(3);
  scene.parts[2].name = "unused";
  scene.nodes.resize(4);
  scene.nodes[3].name = "leaf";
  scene.nodes[3].part = 1;
  scene.nodes[1].children = {2, 3};
  assign_part_ids(scene);
  EXPECT_EQ(scene.parts[0].id, "root/#0/leaf");
  EXPECT_EQ(scene.parts[1].id, "root/#0/leaf~2");
  EXPECT_EQ(scene.parts[2].id, "unused");
}

TEST(Scene, TransformsUvAsKhrTextureTransform) {
  // In glTF's space (v down) the point is (0.25, 0.5): scaled (0.5, 2), shifted (0.6, 2.2), back up: −1.2.
  const Vec2 moved = transform_uv({{0.1, 0.2}, 0, {2, 4}}, {0.25, 0.5});
  EXPECT_NEAR(moved.x, 0.6, 1e-15);
  EXPECT_NEAR(moved.y, -1.2, 1e-15);
  // A quarter turn, counter-clockwise as seen with v down: (1, 0) goes to (0, −1).
  const Vec2 turned = transform_uv({{0, 0}, std::numbers::pi / 2, {1, 1}}, {1, 1});
  EXPECT_NEAR(turned.x, 0, 1e-15);
  EXPECT_NEAR(turned.y, 2, 1e-15);
}

TEST(Scene, SinglePartSceneHasOneInstance) {
  Part part;
  part.name = "a";
  const Scene scene = single_part_scene(part, "test");
  EXPECT_EQ(scene.format, "test");
  EXPECT_EQ(scene.parts[0].id, "a");
  EXPECT_EQ(instances(scene).size(), 1U);
}

}  // namespace
}  // namespace papilla
