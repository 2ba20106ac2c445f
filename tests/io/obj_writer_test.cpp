// SPDX-License-Identifier: MIT
#include "papilla/io/mesh_files.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "io/scene_fixtures.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using test::TemporaryFolder;

constexpr double k_volume_times_6 = 6 * (40.0 * 40 * 40 + 20.0 * 20 * 20);

TEST(ObjWriter, InstancesAreWrittenInPlace) {
  const TemporaryFolder folder;
  const Scene scene = test::rich_scene();
  write_obj(scene, folder / "a b.obj");
  const Scene back = read_obj(folder / "a b.obj");
  ASSERT_EQ(back.parts.size(), 2U);
  EXPECT_EQ(back.parts[0].name, "left");
  EXPECT_TRUE(back.warnings.empty());
  EXPECT_EQ(back.parts[0].mesh.corner(0, 0), transform_point(scene.nodes[1].local, scene.parts[0].mesh.corner(0, 0)));
  EXPECT_EQ(back.parts[0].mesh.uv.values, scene.parts[0].mesh.uv.values);
  EXPECT_EQ(back.parts[0].mesh.uv.indices, scene.parts[0].mesh.uv.indices);
  EXPECT_EQ(back.parts[0].mesh.material, scene.parts[0].mesh.material);
  EXPECT_NEAR(test::signed_volume_times_6(back), k_volume_times_6, 1e-6) << "the mirrored cube faces outwards too";
}

TEST(ObjWriter, MaterialsAndPicturesComeBack) {
  const TemporaryFolder folder;
  const Scene scene = test::rich_scene();
  write_obj(scene, folder / "a.obj");
  const Scene back = read_obj(folder / "a.obj");
  ASSERT_EQ(back.materials.size(), 2U);
  EXPECT_EQ(back.materials[0].name, "grain");
  EXPECT_EQ(back.materials[0].base_color, scene.materials[0].base_color);
  EXPECT_EQ(back.materials[0].roughness, 0.5);
  EXPECT_EQ(back.materials[1].metallic, 1);
  ASSERT_TRUE(back.materials[0].base_color_texture && back.materials[0].normal_texture);
  const auto& texture = back.textures.at(back.materials[0].base_color_texture->texture);
  EXPECT_EQ(back.images.at(*texture.image).bytes, scene.images[0].bytes);
  const Vec2 uv{0.3, 0.6};
  EXPECT_EQ(transform_uv(*back.materials[0].normal_texture->transform, uv),
            transform_uv(*scene.materials[0].normal_texture->transform, uv));
  EXPECT_EQ(folder.files(), 3U) << "OBJ, MTL and one picture";
}

TEST(ObjWriter, NumbersComeBackExactly) {
  const TemporaryFolder folder;
  Part part;
  part.mesh.positions = {{std::numbers::pi, 1.0 / 3, -1e-300}, {1e300, 0, 0.1}, {0, 5e-324, 2}};
  part.mesh.triangles = {{0, 1, 2}};
  const Scene scene = single_part_scene(part, "test");
  write_obj(scene, folder / "a.obj");
  EXPECT_EQ(read_obj(folder / "a.obj").parts.at(0).mesh.positions, part.mesh.positions);
  EXPECT_EQ(folder.files(), 1U) << "no materials, no MTL";
}

TEST(ObjWriter, RefusesBadNumbersAndFullDisks) {
  const TemporaryFolder folder;
  Scene scene = test::rich_scene();
  if (std::filesystem::exists("/dev/full")) {
    scene.materials.clear();
    scene.parts[0].materials.clear();
    EXPECT_THROW(write_obj(scene, "/dev/full"), IoError);
    EXPECT_THROW(write_stl(scene, "/dev/full"), IoError);
  }
  scene.parts[0].mesh.uv.values[0].x = std::nan("");
  EXPECT_THROW(write_obj(scene, folder / "a.obj"), InvalidInput);
  scene.parts[0].mesh.uv.indices[0][0] = 99;
  EXPECT_THROW(write_obj(scene, folder / "a.obj"), InvalidInput);
  EXPECT_EQ(folder.files(), 0U);
}

TEST(StlWriter, InstancesAreWrittenInPlace) {
  const TemporaryFolder folder;
  const Scene scene = test::rich_scene();
  write_stl(scene, folder / "a.stl");
  const Scene back = read_stl(folder / "a.stl");
  EXPECT_EQ(back.parts.at(0).mesh.triangles.size(), 24U);
  EXPECT_EQ(back.parts[0].mesh.positions.size(), 16U);
  EXPECT_NEAR(test::signed_volume_times_6(back), k_volume_times_6, 1e-3);
  EXPECT_EQ(std::filesystem::file_size(folder / "a.stl"), 84U + 24 * 50);
}

TEST(StlWriter, RefusesWhatNoFloatCanHold) {
  const TemporaryFolder folder;
  Scene scene = test::rich_scene();
  scene.parts[0].mesh.positions[0].x = 1e300;
  EXPECT_THROW(write_stl(scene, folder / "a.stl"), InvalidInput);
}

}  // namespace
}  // namespace papilla
