// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "papilla/io/scene.hpp"
#include "papilla/pipeline/bake_scene.hpp"
#include "papilla/pipeline/texture_files.hpp"

namespace papilla {

/// What write_texture_on_scene() returns.
struct TextureOnScene {
  std::string scene;                  ///< Name in the folder.
  std::vector<std::string> pictures;  ///< The same: base colour, normals and, where they differ, metallic-roughness.
  BakeResult baked;
};

/// Puts one recipe on all surfaces of a scene, as bake_scene() does of one material, and writes the scene and its
/// pictures into a folder, which is made when it is missing. Surfaces without usable uv are unwrapped; a recipe that
/// reads position, normal or sky gets an atlas, any other a tile of `size_mm`.
/// @param options  time, size_mm and depth_mm; the others are of pictures without a scene.
/// @throws InvalidInput, IoError as bake_scene() and write_scene().
TextureOnScene write_texture_on_scene(const std::string& recipe, const RecipeLibrary& library, Scene scene,
                                      const std::filesystem::path& folder, const TextureFileOptions& options = {});

}  // namespace papilla
