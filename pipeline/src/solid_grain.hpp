// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "papilla/pipeline/grain.hpp"
#include "papilla/procedural/texture.hpp"
#include "surface/painted_surface.hpp"

namespace papilla {

/// The recipe that a rule has as texture; nothing where that is a file or a test grain.
/// @throws InvalidInput as compile_texture().
std::optional<ProceduralTexture> recipe_of(const MaterialRule& rule, const RecipeLibrary& library, bool seamless);

/// Whether a recipe looks different from place to place of one repeat: it reads position, normal or sky.
bool reads_surface(const ProceduralTexture& texture);

/// The grain of a surface that the rule's recipe was painted on.
/// @param tile  make_grain() of the rule, whose size one repeat has. @param name  of its pictures.
Grain solid_grain(const MaterialRule& rule, const Grain& tile, PaintedSurface painted, const std::string& name);

}  // namespace papilla
