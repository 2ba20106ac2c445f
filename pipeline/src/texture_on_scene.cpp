// SPDX-License-Identifier: MIT
#include "papilla/pipeline/texture_on_scene.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "papilla/core/atomic_file.hpp"
#include "papilla/io/scene_file.hpp"

namespace papilla {
namespace {

constexpr const char* k_material = "texture";

Materials rules_of(const std::string& recipe, const TextureFileOptions& options) {
  MaterialRule rule;
  rule.name = k_material;
  rule.recipe = recipe, rule.texture = recipe;
  rule.time = options.time;
  rule.size_mm[0] = rule.size_mm[1] = options.size_mm;
  rule.height.depth_mm = options.depth_mm;
  rule.show = "picture";
  Materials rules;
  rules.materials.emplace(rule.name, rule);
  rules.assign.emplace_back().material = rule.name;
  return rules;
}

/// Of the pictures of a grain, not of those that the scene had.
bool is_of_recipe(const EncodedImage& image) {
  constexpr std::array<std::string_view, 3> k_kinds{"grain.", "normal.", "metallic_roughness."};
  return std::any_of(k_kinds.begin(), k_kinds.end(),
                     [&](std::string_view kind) { return image.name.starts_with(std::string(kind) + k_material); });
}

}  // namespace

TextureOnScene write_texture_on_scene(const std::string& recipe, const RecipeLibrary& library, Scene scene,
                                      const std::filesystem::path& folder, const TextureFileOptions& options) {
  BakeOptions bake;
  bake.library = library;
  TextureOnScene made;
  for (Material& material : scene.materials)  // What it looked like is no part of the recipe.
    material.base_color_texture.reset(), material.normal_texture.reset(), material.metallic_roughness_texture.reset();
  made.baked = bake_scene(std::move(scene), rules_of(recipe, options), bake, options.progress);
  make_folder(folder);
  made.scene = "scene.glb";
  for (std::string& loss : write_scene(made.baked.scene, folder / made.scene))
    made.baked.scene.losses.push_back(std::move(loss));
  for (const EncodedImage& image : made.baked.scene.images) {
    if (!is_of_recipe(image)) continue;
    made.pictures.push_back(image.name + ".png");
    write_atomically(folder / made.pictures.back(),
                     std::string_view(reinterpret_cast<const char*>(image.bytes.data()), image.bytes.size()));
  }
  return made;
}

}  // namespace papilla
