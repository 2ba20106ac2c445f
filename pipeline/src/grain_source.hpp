// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "papilla/cache/digest.hpp"
#include "papilla/pipeline/materials.hpp"
#include "papilla/pipeline/quantity_maps.hpp"
#include "papilla/procedural/library.hpp"
#include "papilla/procedural/texture.hpp"
#include "papilla/texture/image.hpp"
#include "surface/painted_surface.hpp"

/// What a grain is made from: pictures, recipes and test grains that a rule names.
namespace papilla {

/// More samples than this a side show and feel like nothing: at 40 mm a repeat they are finer than 0.04 mm.
inline constexpr int k_most_samples = 1024;

/// The picture of a material, from a file or computed.
struct SourcePicture {
  GreyImage grey;  ///< Of a recipe or test grain: heights.
  ColorImage color;
  Transfer transfer = Transfer::automatic;
  bool solid = false;                     ///< Of a recipe that reads the surface.
  bool computed = false;                  ///< Of a recipe or a test grain: heights, not a photograph.
  std::optional<double> friction = {};    ///< Of a recipe: mean of the channel.
  double stiffness = 1, damping = 1;      ///< The same.
  Shine shine = {};                       ///< The same, where the rule does not say it.
  std::optional<QuantityMaps> maps = {};  ///< The same: the channels over their means.
};

/// A file of that name wins over a recipe of that name.
/// @throws IoError, InvalidInput naming the material and the picture or the place in the recipe.
SourcePicture read_source(const MaterialRule& rule, const RecipeLibrary& library);

/// What a recipe gave on a surface, as the picture of a material.
SourcePicture painted_source(const MaterialRule& rule, PaintedSurface painted);

/// From the deepest to the highest point of a grain, or a recipe's height of 1: the rule's, else 1 % of the shorter
/// side.
inline double depth_mm_of(const MaterialRule& rule, const double (&size_mm)[2]) {
  constexpr double k_share = 0.01;
  return rule.height.depth_mm.value_or(k_share * std::min(size_mm[0], size_mm[1]));
}

/// Whether a picture is to be the base colour. @param monochrome  of the picture, is_monochrome().
inline bool shows_picture(const MaterialRule& rule, bool monochrome) {
  return rule.show == "picture" || (rule.show == "auto" && !monochrome);
}

/// Where a map stands in a rule, for messages: "maps/friction".
std::string key_of_map(Quantity quantity);

/// The maps of the rule, and those of its recipe for other quantities, in multiples of the constants, over one picture.
/// @throws as read_source().
QuantityMaps read_maps(const MaterialRule& rule, std::optional<QuantityMaps> of_recipe, const RecipeLibrary& library);

/// Digests of the pictures that a rule's grain is made from, in the order in which the rule names them. What can't be
/// read is left out: read_source() says so.
/// @throws InvalidInput as compile_texture().
std::vector<Digest> picture_digests(const MaterialRule& rule, const RecipeLibrary& library);

/// The recipe that a rule has as texture; nothing where that is a file or a test grain.
/// @throws InvalidInput as compile_texture().
std::optional<ProceduralTexture> recipe_of(const MaterialRule& rule, const RecipeLibrary& library, bool seamless);

/// Whether a recipe looks different from place to place of one repeat: it reads position, normal or sky.
bool reads_surface(const ProceduralTexture& texture);

}  // namespace papilla
