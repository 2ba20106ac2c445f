// SPDX-License-Identifier: MIT
#include "papilla/pipeline/studio/recipe_atlas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "papilla/core/error.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/studio/recipe_look.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla {
namespace {

constexpr double k_cube_mm = 80;
constexpr int k_side = 512;

/// Waves of 0.1 m in space, and a relief of them.
constexpr const char* k_wood =
    "base|colorfunction=rgb(.5+.4*s(60*posx),.5+.4*s(60*posy),.5+.4*s(60*posz))|bumpfunction=.5+.5*s(60*posx+40*posy)|"
    "roughnessfunction=.5+.3*s(60*posz)";
/// Of its colours, and of its roughness, at most, by a millimetre.
constexpr double k_steepness = 0.4 * 60 * 0.001;
constexpr const char* k_bricks = "brick|scale=.5";

const RecipeLibrary& library() {
  static const RecipeLibrary all = RecipeLibrary::builtin();
  return all;
}

ProceduralTexture compiled(const std::string& recipe, bool seamless = false) {
  return compile_for_look(recipe, library(), ".", 0, seamless);
}

StudioScene cube_scene() {
  Part cube;
  cube.name = "cube";
  cube.mesh = test::cube(k_cube_mm);
  BakeOptions options;
  options.library = library();
  return {single_part_scene(std::move(cube), "test"), options, false};
}

std::string document_of(const std::string& recipe, const std::string& more = {}) {
  return R"({"materials": {"m": {"texture": ")" + recipe +
         R"(", "size_mm": [40, 40], "show": "picture", "height": {"depth_mm": 0.2})" + more +
         R"(}}, "assign": [{"part": "*", "material": "m"}]})";
}

StudioPlan plan_of(const StudioScene& scene, const std::string& recipe, const std::string& more = {}) {
  return scene.plan(document_of(recipe, more), "m.json", {});
}

/// The look of a recipe while the document has another.
std::pair<std::shared_ptr<const RecipeAtlas>, RecipeLook> live(StudioScene& scene, const std::string& kept,
                                                               const std::string& recipe, int side = k_side) {
  const StudioPlan plan = plan_of(scene, kept);
  const auto atlas = scene.recipe_atlas(plan, plan.wishes.at(0), compiled(recipe), side);
  const std::vector looks =
      recipe_looks(plan.rules.materials.at("m"), compiled(recipe), compiled(recipe, true), std::array{atlas});
  return {atlas, looks.at(0)};
}

/// RGBA of 8 bits.
struct Pixels {
  int width = 0, height = 0;
  std::vector<unsigned char> rgba;
};

Pixels decoded(const Scene& look, const std::optional<TextureReference>& reference) {
  EXPECT_TRUE(reference && reference->tex_coord == 0 && !reference->transform);
  const ColorImage image = decode_color_image(look.images[*look.textures[reference->texture].image].bytes, "picture");
  Pixels pixels{image.width, image.height, {}};
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    pixels.rgba.push_back(image.pixels[i]);
    if (i % 3 == 2) pixels.rgba.push_back(255);
  }
  return pixels;
}

/// Bilinear, at a place of uv with v up, in [0, 1].
std::array<double, 3> sample(const Pixels& image, Vec2 uv) {
  const double x = uv.x * image.width - 0.5, y = (1 - uv.y) * image.height - 0.5, left = std::floor(x),
               top = std::floor(y);
  std::array<double, 3> out{};
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const auto column = static_cast<std::size_t>(std::clamp(static_cast<int>(left) + i, 0, image.width - 1)),
                 row = static_cast<std::size_t>(std::clamp(static_cast<int>(top) + j, 0, image.height - 1));
      const double share = (1 - std::abs(x - left - i)) * (1 - std::abs(y - top - j));
      for (std::size_t k = 0; k < 3; ++k)
        out[k] += share / 255 * image.rgba[4 * (row * static_cast<std::size_t>(image.width) + column) + k];
    }
  return out;
}

Vec2 uv_at(const ShownMesh& mesh, std::size_t triangle, const std::array<double, 3>& weights) {
  Vec2 uv;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t v = mesh.indices[3 * triangle + k];
    uv = uv + weights[k] * Vec2{double{mesh.uv[2 * v]}, double{mesh.uv[2 * v + 1]}};
  }
  return uv;
}

Vec3 place_at(const ShownMesh& mesh, std::size_t triangle, const std::array<double, 3>& weights) {
  Vec3 place;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t v = mesh.indices[3 * triangle + k];
    place = place + weights[k] * Vec3{double{mesh.positions[3 * v]}, double{mesh.positions[3 * v + 1]},
                                      double{mesh.positions[3 * v + 2]}};
  }
  return place;
}

/// Of the first triangle.
double mm_per_texel(const ShownMesh& mesh, const Pixels& picture) {
  const std::array<double, 3> a{1, 0, 0}, b{0, 1, 0};
  const Vec2 d = uv_at(mesh, 0, b) - uv_at(mesh, 0, a);
  return norm(place_at(mesh, 0, b) - place_at(mesh, 0, a)) / std::hypot(d.x * picture.width, d.y * picture.height);
}

constexpr std::array<std::array<double, 3>, 4> k_places{
    {{1.0 / 3, 1.0 / 3, 1.0 / 3}, {0.8, 0.1, 0.1}, {0.1, 0.8, 0.1}, {0.05, 0.15, 0.8}}};

TEST(RecipeAtlas, ShowsWhatIsShownWhenItIsKept) {
  StudioScene scene = cube_scene();
  for (const std::string& before : {std::string(k_bricks), std::string(k_wood)}) {
    const auto [atlas, look] = live(scene, before, k_wood);
    const StudioPlan plan = plan_of(scene, k_wood);
    const StudioSurface kept = scene.bake(plan, plan.wishes.at(0));
    const Material& material = kept.look->materials.at(0);
    const Pixels kept_colour = decoded(*kept.look, material.base_color_texture),
                 kept_normal = decoded(*kept.look, material.normal_texture),
                 kept_shine = decoded(*kept.look, material.metallic_roughness_texture);
    const Pixels colour{look.width, look.height, look.color}, normal{look.width, look.height, look.normal},
        shine{look.width, look.height, look.shine};
    EXPECT_EQ(look.roughness, material.roughness);
    EXPECT_EQ(look.metallic, material.metallic);
    ASSERT_EQ(atlas->mesh.indices.size(), kept.mesh.indices.size());
    const double texel_mm = mm_per_texel(atlas->mesh, colour);
    EXPECT_LT(texel_mm, 1) << "512 x 512 texels on 6 squares of 80 mm";
    // A texel's diagonal of each in the steepest direction, and half a step of 8 bits of both.
    const double tolerance =
        k_steepness * std::sqrt(2) * (texel_mm + mm_per_texel(kept.mesh, kept_colour)) / 2 + 1.0 / 255;
    for (std::size_t t = 0; t < kept.mesh.indices.size() / 3; ++t)
      for (const auto& at : k_places) {
        const Vec3 place = place_at(kept.mesh, t, at);
        ASSERT_LT(norm(place_at(atlas->mesh, t, at) - place), 1e-3);
        const Vec2 uv = uv_at(atlas->mesh, t, at), kept_uv = uv_at(kept.mesh, t, at);
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_NEAR(sample(colour, uv)[k], sample(kept_colour, kept_uv)[k], tolerance) << t;
        EXPECT_NEAR(sample(shine, uv)[1], sample(kept_shine, kept_uv)[1], tolerance) << t;
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_NEAR(sample(normal, uv)[k], sample(kept_normal, kept_uv)[k], 3.0 / 255) << t;
        EXPECT_NEAR(sample(colour, uv)[0], 0.5 + 0.4 * std::sin(0.06 * place.x), tolerance) << t;
      }
  }
}

TEST(RecipeAtlas, IsAsFineAsItsSideAllows) {
  StudioScene scene = cube_scene();
  const auto [fine, large] = live(scene, k_bricks, k_wood);
  const auto [coarse, small] = live(scene, k_bricks, k_wood, 128);
  EXPECT_GT(large.width * large.height, 10 * small.width * small.height);
  EXPECT_LE(small.width * small.height, 2 * 128 * 128);
  EXPECT_EQ(fine->mesh.positions.size() / 3, fine->mesh.uv.size() / 2);
}

TEST(RecipeAtlas, OfARecipeThatReadsNothingIsItsTile) {
  StudioScene scene = cube_scene();
  const auto [atlas, look] = live(scene, k_wood, k_bricks);
  const StudioPlan plan = plan_of(scene, k_bricks);
  const RecipeLook tile = recipe_look(plan.rules.materials.at("m"), compiled(k_bricks, true), k_side);
  EXPECT_EQ(look.color, tile.color);
  EXPECT_EQ(look.normal, tile.normal);
  EXPECT_EQ(look.shine, tile.shine);
  const StudioSurface kept = scene.bake(plan, plan.wishes.at(0));
  EXPECT_EQ(atlas->mesh.uv, kept.mesh.uv);
}

TEST(RecipeAtlas, IsTheSameForRecipesThatLookAtTheSame) {
  const StudioScene scene = cube_scene();
  const auto key = [&](const std::string& kept, const std::string& recipe, int side = k_side,
                       const std::string& more = {}) {
    return recipe_atlas_key(plan_of(scene, kept, more).wishes.at(0), compiled(recipe), side);
  };
  const std::string wood = key(k_bricks, k_wood);
  EXPECT_EQ(wood, key(k_bricks, "base|mainfunction=s(7*posx)")) << "another recipe";
  EXPECT_EQ(wood, key(k_wood, k_wood)) << "and when it is kept";
  EXPECT_EQ(wood, key(k_wood, k_wood, k_side, R"(, "time": 0.5)")) << "or aged";
  EXPECT_NE(wood, key(k_bricks, k_bricks));
  EXPECT_NE(wood, key(k_bricks, "base|mainfunction=sky"));
  EXPECT_NE(key(k_bricks, k_bricks), key(k_bricks, "base|mainfunction=sky")) << "of two that read no position";
  EXPECT_NE(wood, key(k_bricks, k_wood, k_side / 2));
  EXPECT_NE(wood, key(k_bricks, k_wood, k_side, R"(, "phase_mm": [3, 0])"));
  EXPECT_NE(key(k_bricks, "base|mainfunction=normaldot"),
            key(k_bricks, "base|mainfunction=normaldot|dirtdirection=<1,0,0>"));
}

TEST(RecipeAtlas, RefusesAndCanBeEnded) {
  StudioScene scene = cube_scene();
  const StudioPlan plan = plan_of(scene, k_bricks);
  const auto ends = [](const Progress&) { return false; };
  EXPECT_THROW(scene.recipe_atlas(plan, plan.wishes.at(0), compiled(k_wood), 8), InvalidInput);
  EXPECT_THROW(scene.recipe_atlas(plan, plan.wishes.at(0), compiled(k_wood), 64, ends), Cancelled);
  const auto atlas = scene.recipe_atlas(plan, plan.wishes.at(0), compiled(k_wood), 64);
  EXPECT_THROW(
      recipe_looks(plan.rules.materials.at("m"), compiled(k_wood), compiled(k_wood, true), std::array{atlas}, ends),
      Cancelled);
  EXPECT_NEAR(scene.area_mm2(0, 0), 6 * k_cube_mm * k_cube_mm, 1e-6);
}

}  // namespace
}  // namespace papilla
