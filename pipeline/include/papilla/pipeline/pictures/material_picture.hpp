// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/pipeline/materials.hpp"
#include "papilla/procedural/library.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

class StageCache;

struct MaterialPictureOptions {
  int side_px = 320;                                 ///< Of each of the two pictures; 64 to 2048.
  double ball_mm = 60;                               ///< Diameter of the ball: grain on it has its real size.
  RecipeLibrary library = RecipeLibrary::builtin();  ///< What the rule's recipe may name.
  const StageCache* cache = nullptr;                 ///< Remembers the grain; null: none.
};

/// Two pictures side by side: a lit ball that is baked with the rule, as render_scene() shows it, and one repeat of its
/// relief as a map that is lit from the top left, with a scale bar. Gentle relief is exaggerated there; a material
/// without relief has an even grey. Deterministic. Cost: make_grain() and a small rendering.
/// @throws InvalidInput for a side out of range, and as make_grain().
ColorImage material_picture(const MaterialRule& rule, const MaterialPictureOptions& options = {});

}  // namespace papilla
