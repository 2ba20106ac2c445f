// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "bake/materials_file.hpp"
#include "papilla/haptic/material_tag.hpp"
#include "papilla/io/scene.hpp"
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
  nlohmann::ordered_json report;
  GrainSeconds seconds;
};

/// Analyses the rule's picture and turns it into relief.
/// @throws IoError, InvalidInput naming the picture.
Grain make_grain(const MaterialRule& rule);

/// Copies the rule's haptic constants into a tag.
void apply_constants(const MaterialRule& rule, MaterialTag& tag);

}  // namespace papilla::app
