// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/temporary_folder.hpp"
#include "papilla/io/height_source.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/pipeline/bake_file.hpp"
#include "papilla/pipeline/bake_scene.hpp"
#include "papilla/pipeline/texture_on_scene.hpp"

namespace papilla {
namespace {

/// A block of 100 x 60 x 40 mm without uv, whose faces share their vertices.
Part block() {
  Part part;
  part.name = "block";
  for (int i = 0; i < 8; ++i)
    part.mesh.positions.push_back({i & 1 ? 100.0 : 0.0, i & 2 ? 60.0 : 0.0, i & 4 ? 40.0 : 0.0});
  for (const auto& [a, b, c, d] :
       {std::array{0U, 2U, 3U, 1U}, std::array{4U, 5U, 7U, 6U}, std::array{0U, 1U, 5U, 4U}, std::array{2U, 6U, 7U, 3U},
        std::array{0U, 4U, 6U, 2U}, std::array{1U, 3U, 7U, 5U}}) {
    part.mesh.triangles.push_back({a, b, c});
    part.mesh.triangles.push_back({a, c, d});
  }
  return part;
}

/// Turned about two axes, and stretched by 1.5, 0.7 and 1: before, or behind, which shears.
Transform odd_pose(bool shears = false) {
  const double c = std::cos(0.5), s = std::sin(0.5), d = std::cos(0.9), e = std::sin(0.9);
  const Transform turn = {c, -s, 0, 0, s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                  tip = {1, 0, 0, 0, 0, d, -e, 0, 0, e, d, 0, 0, 0, 0, 1},
                  stretch = {1.5, 0, 0, 70, 0, 0.7, 0, -20, 0, 0, 1, 15, 0, 0, 0, 1};
  const Transform turned = multiply(turn, tip);
  return shears ? multiply(stretch, turned) : multiply(turned, stretch);
}

Scene scene_of(const Transform& pose) {
  Scene scene = single_part_scene(block(), "test");
  scene.nodes[0].local = pose;
  return scene;
}

/// Waves of 0.1 m in space: grain that goes on around edges.
constexpr const char* k_wood =
    "base|colorfunction=rgb(.5+.4*s(60*posx),.5+.4*s(60*posy),.5+.4*s(60*posz))|bumpfunction=.5+.5*s(60*posx+40*posy)|"
    "roughnessfunction=.5+.3*s(60*posz)|frictionfunction=.4+.2*s(60*posy)";

MaterialRule wood() {
  MaterialRule rule;
  rule.name = "wood";
  rule.recipe = rule.texture = k_wood;
  rule.size_mm[0] = rule.size_mm[1] = 80;
  rule.height.depth_mm = 0.2;
  rule.stiffness = 800;
  return rule;
}

Materials rules_of(const MaterialRule& rule) {
  Materials rules;
  rules.materials.emplace(rule.name, rule);
  rules.assign.emplace_back().material = rule.name;
  return rules;
}

/// Bilinear, at a place of uv with v up.
std::array<double, 3> sample(const ColorImage& image, Vec2 uv) {
  const double x = uv.x * image.width - 0.5, y = (1 - uv.y) * image.height - 0.5;
  const double left = std::floor(x), top = std::floor(y);
  std::array<double, 3> out{};
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const int column = std::clamp(static_cast<int>(left) + i, 0, image.width - 1),
                row = std::clamp(static_cast<int>(top) + j, 0, image.height - 1);
      const double share = (1 - std::abs(x - left - i)) * (1 - std::abs(y - top - j));
      for (std::size_t k = 0; k < 3; ++k)
        out[k] += share / 255 *
                  image.pixels[3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                                    static_cast<std::size_t>(column)) +
                               k];
    }
  return out;
}

ColorImage picture_of(const Scene& scene, const std::optional<TextureReference>& reference) {
  EXPECT_TRUE(reference && reference->tex_coord == 0 && !reference->transform);
  return decode_image(scene, *scene.textures[reference->texture].image);
}

/// A point on an edge: its place in the scene, y up, in metres, and its uv in one triangle.
struct Seen {
  Vec3 place;
  Vec2 uv;
};

/// Points along all edges, by the triangle that has them; equal keys are the same point in the part.
std::map<std::array<long, 3>, std::vector<Seen>> edge_points(const Scene& scene, const Instance& use) {
  std::map<std::array<long, 3>, std::vector<Seen>> points;
  const TriangleMesh& mesh = scene.parts[use.part].mesh;
  const Transform world = multiply(to_y_up(scene.up), use.world);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      for (const double share : {0.2, 0.5, 0.8}) {
        const int n = (k + 1) % 3;
        const Vec3 p = (1 - share) * mesh.corner(t, k) + share * mesh.corner(t, n);
        const auto& corner = mesh.uv.indices[t];
        const Vec2 uv = (1 - share) * mesh.uv.values[corner[static_cast<std::size_t>(k)]] +
                        share * mesh.uv.values[corner[static_cast<std::size_t>(n)]];
        points[{std::lround(1e3 * p.x), std::lround(1e3 * p.y), std::lround(1e3 * p.z)}].push_back(
            {0.001 * transform_point(world, p), uv});
      }
  return points;
}

/// Both sides of every seam show the recipe at their place, to the tolerance of a texel. @return seams that were met.
int expect_continuous(const Scene& scene, const Instance& use, double mm_per_texel) {
  const std::vector<std::uint32_t>& slots = scene.parts[use.part].materials;
  const Material& material = scene.materials.at(slots.at(0));
  const ColorImage color = picture_of(scene, material.base_color_texture),
                   shine = picture_of(scene, material.metallic_roughness_texture);
  // A texel's diagonal in the steepest direction, and half a step of 8 bits.
  const double tolerance = 0.4 * 60 * 0.001 * mm_per_texel * std::sqrt(2) + 0.5 / 255;
  int seams = 0;
  for (const auto& [key, sides] : edge_points(scene, use))
    for (const Seen& side : sides) {
      const std::array<double, 3> seen = sample(color, side.uv);
      const double at[3] = {side.place.x, side.place.y, side.place.z};
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], 0.5 + 0.4 * std::sin(60 * at[k]), tolerance);
      EXPECT_NEAR(sample(shine, side.uv)[1], 0.5 + 0.3 * std::sin(60 * at[2]), tolerance);
      const std::array<double, 3> other = sample(color, sides.front().uv);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], other[k], tolerance) << "across a seam";
      seams += std::hypot(side.uv.x - sides.front().uv.x, side.uv.y - sides.front().uv.y) > 1e-3;
    }
  return seams;
}

TEST(BakeSolid, WoodGoesOnAroundAnEdge) {
  for (const Transform& pose : {k_identity, odd_pose(), odd_pose(true)}) {
    const BakeResult result = bake_scene(scene_of(pose), rules_of(wood()));
    ASSERT_EQ(result.atlases.size(), 1U);
    const BakedAtlas& atlas = result.atlases[0];
    EXPECT_GE(atlas.charts, 1U);
    EXPECT_NEAR(atlas.mm_per_texel, 80.0 / 512, 1e-9) << "as fine as the tile";
    const std::vector<Instance> uses = instances(result.scene);
    ASSERT_EQ(uses.size(), 1U);
    EXPECT_GT(expect_continuous(result.scene, uses[0], 1.5 * atlas.mm_per_texel), 10) << "there are seams";
  }
}

TEST(BakeSolid, ReliefAndFrictionLieOnTheAtlas) {
  const BakeResult result = bake_scene(scene_of(k_identity), rules_of(wood()));
  const Scene& scene = result.scene;
  const std::uint32_t number = scene.parts[0].materials.at(0);
  const Material& material = scene.materials.at(number);
  const MaterialTag& tag = material.haptic.value();
  ASSERT_TRUE(tag.height && tag.maps);
  EXPECT_EQ(tag.height->tex_coord, 0);
  const ColorImage color = picture_of(scene, material.base_color_texture);
  EXPECT_EQ(tag.height->size, (std::array<int, 2>{color.width, color.height}));
  EXPECT_NE(color.width, color.height);
  EXPECT_NEAR(tag.height->metres_per_uv.x, color.width * 0.08 / 512, 1e-9);
  EXPECT_NEAR(tag.height->metres_per_uv.y, color.height * 0.08 / 512, 1e-9);
  EXPECT_NEAR(result.mm_per_uv.at(number).x, color.width * 80.0 / 512, 1e-6);
  EXPECT_NEAR(result.mm_per_uv[number].y, color.height * 80.0 / 512, 1e-6);
  std::vector<HapticWarning> warnings;
  const auto maps = find_maps(*tag.maps, scene, "block.glb", 0, warnings);
  ASSERT_TRUE(maps && warnings.empty());
  for (const auto& [key, sides] : edge_points(scene, instances(scene)[0]))
    for (const Seen& side : sides) {
      ContactConstants there;
      there.static_friction = tag.static_friction, there.dynamic_friction = tag.dynamic_friction;
      maps->apply({side.uv.x, 1 - side.uv.y}, there);
      EXPECT_NEAR(there.dynamic_friction, 0.4 + 0.2 * std::sin(60 * side.place.y), 0.01);
    }
}

TEST(BakeSolid, EachInstanceIsCutOutOfOneBlockOfWood) {
  Scene scene = scene_of(k_identity);
  Node other;
  other.part = 0;
  other.local[3] = 37, other.local[11] = 11;
  scene.nodes.push_back(other), scene.roots.push_back(1);
  const BakeResult result = bake_scene(std::move(scene), rules_of(wood()));
  const std::vector<Instance> uses = instances(result.scene);
  ASSERT_EQ(uses.size(), 2U);
  EXPECT_NE(uses[0].part, uses[1].part) << "they look unlike";
  for (const Instance& use : uses) expect_continuous(result.scene, use, result.atlases.at(0).mm_per_texel);
}

TEST(BakeSolid, ALargeSurfaceGetsACoarserAtlasAndSaysSo) {
  MaterialRule fine = wood();
  fine.size_mm[0] = fine.size_mm[1] = 8;
  const BakeResult result = bake_scene(scene_of(k_identity), rules_of(fine));
  EXPECT_LE(std::max(result.atlases.at(0).width, result.atlases[0].height), 4096);
  EXPECT_GT(result.atlases[0].mm_per_texel, 8.0 / 512);
  EXPECT_TRUE(std::any_of(result.scene.warnings.begin(), result.scene.warnings.end(), [](const std::string& warning) {
    return warning.find("its recipe reads the surface") != std::string::npos;
  }));
}

TEST(BakeSolid, OtherRecipesKeepTheirTile) {
  MaterialRule rule = wood();
  rule.recipe = rule.texture = "oak";
  const BakeResult result = bake_scene(scene_of(k_identity), rules_of(rule));
  EXPECT_TRUE(result.atlases.empty());
  EXPECT_NEAR(result.scene.materials.at(0).haptic.value().height.value().metres_per_uv.x, 0.08, 1e-9);
}

TEST(BakeSolid, AGltfFileIsWrittenAnewForAnAtlas) {
  const TemporaryFolder folder("papilla-solid");
  write_scene(scene_of(odd_pose()), folder / "block.glb");
  const BakeFileResult solid = bake_file(folder / "block.glb", folder / "solid.glb", rules_of(wood()), {});
  EXPECT_FALSE(solid.way.in_place);
  EXPECT_NE(std::string(solid.way.reason).find("reads the surface"), std::string::npos);
  const Scene read = read_scene(folder / "solid.glb");
  EXPECT_GT(expect_continuous(read, instances(read).at(0), 1.5 * solid.atlases.at(0).mm_per_texel), 10);
  MaterialRule tile = wood();
  tile.recipe = tile.texture = "oak";
  EXPECT_TRUE(bake_file(folder / "block.glb", folder / "tile.glb", rules_of(tile), {}).way.in_place);
}

TEST(TextureOnScene, WritesASceneAndItsPictures) {
  const TemporaryFolder folder("papilla-texture-on");
  TextureFileOptions options;
  options.size_mm = 80;
  const TextureOnScene made =
      write_texture_on_scene(k_wood, RecipeLibrary::builtin(), scene_of(odd_pose()), folder / "out", options);
  EXPECT_EQ(made.pictures.size(), 3U) << "colour, normals, metallic-roughness";
  for (const std::string& name : made.pictures) EXPECT_GT(read_file(folder / "out" / name).size(), 100U) << name;
  const Scene read = read_scene(folder / "out" / made.scene);
  EXPECT_GT(expect_continuous(read, instances(read).at(0), 1.5 * made.baked.atlases.at(0).mm_per_texel), 10);
  EXPECT_THROW(write_texture_on_scene("oka", RecipeLibrary::builtin(), scene_of(k_identity), folder / "none", {}),
               Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "none"));
}

}  // namespace
}  // namespace papilla
