// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "io/glb_fixture.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/gltf_reader.hpp"

namespace papilla {
namespace {

using test::GlbFixture;
using test::message_of;
using test::TemporaryFolder;

/// A triangle shown by a node one metre up y, with these instance attributes.
std::string instanced(GlbFixture& glb, const std::string& attributes, const std::string& more_of_node = "") {
  const int positions = glb.positions(test::row_of_points(3));
  return glb.glb(R"("extensionsUsed":["EXT_mesh_gpu_instancing"],"extensionsRequired":["EXT_mesh_gpu_instancing"],)"
                 R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"seats","mesh":0,"translation":[0,1,0],)" +
                 more_of_node + R"("extensions":{"EXT_mesh_gpu_instancing":{"attributes":{)" + attributes +
                 R"(}}}}],"meshes":[{"primitives":[{"attributes":{"POSITION":)" + std::to_string(positions) + "}}]}],");
}

TEST(GltfInstancing, EachPlaceBecomesAChildNode) {
  GlbFixture glb;
  const int t = glb.accessor(glb.view(std::vector<float>{0, 0, 0, 5, 0, 0}), 5126, 2, "VEC3");
  // A quarter turn about z as normalized shorts: (0, 0, sin 45°, cos 45°).
  const auto q = static_cast<std::int16_t>(std::lround(32767 * std::sqrt(0.5)));
  const int r = glb.accessor(glb.view(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, q, q}), 5122, 2, "VEC4",
                             R"(,"normalized":true)");
  const int s = glb.accessor(glb.view(std::vector<float>{1, 1, 1, 2, 2, 2}), 5126, 2, "VEC3");
  const int id = glb.accessor(glb.view(std::vector<float>{0, 1}), 5126, 2, "SCALAR");
  const TemporaryFolder folder;
  const Scene scene = read_gltf(folder.write(
      "a.glb", instanced(glb, R"("TRANSLATION":)" + std::to_string(t) + R"(,"ROTATION":)" + std::to_string(r) +
                                  R"(,"SCALE":)" + std::to_string(s) + R"(,"_ID":)" + std::to_string(id))));
  const auto shown = instances(scene);
  ASSERT_EQ(shown.size(), 2U);
  EXPECT_EQ(scene.parts.size(), 1U) << "the part is stored once";
  EXPECT_FALSE(scene.nodes[0].part);
  EXPECT_EQ(transform_point(shown[0].world, {1000, 0, 0}), (Vec3{1000, 1000, 0}));
  EXPECT_NEAR(norm(transform_point(shown[1].world, {1000, 0, 0}) - Vec3{5000, 3000, 0}), 0, 1e-9);
  EXPECT_EQ(scene.losses, (std::vector<std::string>{"instances' attribute _ID"}));
  EXPECT_EQ(scene.parts[0].id, "seats/#0");
}

TEST(GltfInstancing, PlacesHaveAllThreeAxes) {
  GlbFixture glb;
  const int t = glb.accessor(glb.view(std::vector<float>{1, 2, 4, -3, 5, 7}), 5126, 2, "VEC3");
  // Half a turn about z and one about x.
  const int r = glb.accessor(glb.view(std::vector<float>{0, 0, 1, 0, 1, 0, 0, 0}), 5126, 2, "VEC4");
  const int s = glb.accessor(glb.view(std::vector<float>{2, 3, 4, 5, 6, 7}), 5126, 2, "VEC3");
  const TemporaryFolder folder;
  const Scene scene =
      read_gltf(folder.write("a.glb", instanced(glb, R"("TRANSLATION":)" + std::to_string(t) + R"(,"ROTATION":)" +
                                                         std::to_string(r) + R"(,"SCALE":)" + std::to_string(s))));
  const auto shown = instances(scene);
  ASSERT_EQ(shown.size(), 2U);
  const Vec3 p{1000, 1000, 1000};  // The node itself stands 1 m higher.
  EXPECT_NEAR(norm(transform_point(shown[0].world, p) - Vec3{-1000, 0, 8000}), 0, 1e-6);
  EXPECT_NEAR(norm(transform_point(shown[1].world, p) - Vec3{2000, 0, 0}), 0, 1e-6);
}

TEST(GltfInstancing, AttributesOfDifferentNumberAreRefused) {
  GlbFixture glb;
  const int t = glb.accessor(glb.view(std::vector<float>{0, 0, 0, 5, 0, 0}), 5126, 2, "VEC3");
  const int s = glb.accessor(glb.view(std::vector<float>{1, 1, 1}), 5126, 1, "VEC3");
  const TemporaryFolder folder;
  const auto path = folder.write(
      "a.glb", instanced(glb, R"("TRANSLATION":)" + std::to_string(t) + R"(,"SCALE":)" + std::to_string(s)));
  EXPECT_NE(message_of<InvalidInput>([&] { read_gltf(path); }).find("differ in number"), std::string::npos);
}

TEST(GltfInstancing, MillionsOfPlacesFromNothingAreRefused) {
  GlbFixture glb;
  const int t = glb.accessor(-1, 5126, 1000000, "VEC3");
  const TemporaryFolder folder;
  const auto path = folder.write("a.glb", instanced(glb, R"("TRANSLATION":)" + std::to_string(t)));
  EXPECT_NE(message_of<InvalidInput>([&] { read_gltf(path); }).find("expands to more elements"), std::string::npos);
}

}  // namespace
}  // namespace papilla
