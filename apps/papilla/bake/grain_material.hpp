// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "bake/materials_file.hpp"
#include "papilla/haptic/material_tag.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/procedural/library.hpp"
#include "papilla/texture/height_map.hpp"

namespace papilla::app {

struct GrainSeconds {
  double analyze = 0, height = 0, normal_map = 0;
};

/// What the picture of a material becomes: relief to be felt, the same relief to be seen, and how the picture is shown.
struct Grain {
  double size_mm[2] = {0, 0};           ///< What one repeat measures.
  HeightMap relief;                     ///< Scaled by the rule's height.scale.
  EncodedImage height_png;              ///< 16-bit grey; decoded by MaterialTag::height.
  EncodedImage normal_png;              ///< From the same relief.
  std::optional<EncodedImage> picture;  ///< The base colour, when the picture is to be shown.
  MaterialTag tag;                      ///< Height, roughness, symmetry, provenance; constants come from the rule.
  double stiffness_factor = 1;          ///< Mean of a recipe's stiffness channel.
  nlohmann::ordered_json report;
  GrainSeconds seconds;
};

/// Analyses the rule's picture and turns it into relief; a recipe is computed at the rule's time.
/// @param library  what recipes may name.
/// @throws IoError, InvalidInput naming the picture or the place in the recipe.
Grain make_grain(const MaterialRule& rule, const RecipeLibrary& library = RecipeLibrary::builtin());

/// Copies the rule's haptic constants into a tag. @param stiffness_factor  multiplies the stiffness, the rule's or the
/// tag's own.
void apply_constants(const MaterialRule& rule, MaterialTag& tag, double stiffness_factor = 1);

}  // namespace papilla::app
