// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/pipeline/materials.hpp"
#include "papilla/pipeline/studio/recipe_atlas.hpp"
#include "papilla/procedural/library.hpp"
#include "papilla/procedural/texture.hpp"

namespace papilla {

/// A recipe as a bake compiles it for a material: pictures in the folder of the document or below it.
/// @param seamless  for a tile; else for an atlas.
/// @throws RecipeError; its source is "recipe" where the mistake is in this text.
ProceduralTexture compile_for_look(const std::string& recipe, const RecipeLibrary& library,
                                   const std::filesystem::path& folder, double time, bool seamless = true);

/// Whether a scene gets an atlas of it, as it reads position, normal, sky or flow: then a tile does not show it.
bool needs_atlas(const ProceduralTexture& texture);

/// How a material is seen while its recipe is being written: one repeat, or the atlas of a surface, RGBA of 8 bits, row
/// by row from the top.
struct RecipeLook {
  int width = 0, height = 0;
  std::vector<unsigned char> color;   ///< Empty: the rule shows the relief alone, in the material's own colour.
  std::vector<unsigned char> normal;  ///< As normal_map().
  std::vector<unsigned char> shine;   ///< Metallic-roughness; empty: the factors alone.
  double roughness = 1, metallic = 0;
};

/// @throws InvalidInput unless looks of so many texels a side are made: 16 to 2048.
void require_look_side(int side);

/// The pictures that make_shown_grain() has of a rule with this recipe at its 512 samples a side, but for its slopes:
/// where the relief is steeper than the rule or its friction allows, only the shown slope is cut, while the grain moves
/// material (limit_slope()). No roughness is laid over it. Cost: that of render_texture(). A callback that returns
/// false ends it by Cancelled.
/// @param rule  its size_mm, depth, scale, show, roughness and metallic. @param side  in texels.
/// @throws InvalidInput as require_look_side().
RecipeLook recipe_look(const MaterialRule& rule, const ProceduralTexture& texture, int side,
                       const ProgressCallback& progress = {});

/// The same on surfaces, one look each, at the coordinates of `RecipeAtlas::mesh`: what StudioScene::bake() shows of
/// the rule with this recipe, at the atlas' resolution and but for slopes and roughness as above. Whether the colour is
/// shown where `show` is "auto" is found from 64 x 64 samples of the tile, the bake's from 512 x 512.
/// Cost: that of evaluate_texture() for all texels that show something.
/// @param texture, tiling  of the recipe, not seamless and seamless. @param atlases  laid out for it; none is null.
std::vector<RecipeLook> recipe_looks(const MaterialRule& rule, const ProceduralTexture& texture,
                                     const ProceduralTexture& tiling,
                                     std::span<const std::shared_ptr<const RecipeAtlas>> atlases,
                                     const ProgressCallback& progress = {});

/// A small picture of a recipe in its own light (light_texture()), RGBA of 8 bits. @pre as recipe_look().
std::vector<unsigned char> recipe_picture(const ProceduralTexture& texture, int side);

}  // namespace papilla
