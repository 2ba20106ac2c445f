// SPDX-License-Identifier: MIT
#include "surface/atlas_uv.hpp"

#include <gtest/gtest.h>

namespace papilla {
namespace {

/// What lay on the old coordinates lies on the second ones, to which these have moved.
TEST(AtlasUv, PicturesAndReliefFollowTheOldCoordinates) {
  Part part;
  part.mesh.positions = {{0, 0, 0}, {10, 0, 0}, {0, 20, 0}};
  part.mesh.triangles = part.mesh.uv.indices = {{0, 1, 2}};
  part.mesh.uv.values = {{0, 0}, {1, 0}, {0, 2}};
  part.materials = {0};
  Scene scene = single_part_scene(std::move(part), "test");
  scene.materials.resize(1);
  Material& material = scene.materials[0];
  material.base_color_texture = material.normal_texture = material.emissive_texture = TextureReference{0, 0, 1, {}};
  material.haptic.emplace().height.emplace();
  material.haptic->maps.emplace();
  const NewUv fresh{0, 0, {Vec2{0.25, 0.5}, Vec2{0.75, 0.5}, Vec2{0.25, 0.875}}};
  set_atlas_uv(scene, instances(scene), {fresh}, std::vector<AtlasMaterial>{{0, true}});
  const TriangleMesh& mesh = scene.parts[0].mesh;
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(mesh.uv.values.at(mesh.uv.indices[0][k]), fresh.uv[k]);
  EXPECT_EQ(mesh.uv1.values.at(mesh.uv1.indices[0][2]), (Vec2{0, 2}));
  EXPECT_EQ(material.base_color_texture->tex_coord, 0);
  EXPECT_EQ(material.normal_texture->tex_coord, 1);
  EXPECT_EQ(material.emissive_texture->tex_coord, 1);
  EXPECT_EQ(material.haptic->height->tex_coord, 1);
  EXPECT_EQ(material.haptic->maps->tex_coord, 1);
}

}  // namespace
}  // namespace papilla
