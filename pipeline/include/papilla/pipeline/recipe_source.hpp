// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "papilla/procedural/texture.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// The built-in recipes and those of the given files.
RecipeLibrary load_recipes(const std::vector<std::string>& files);

/// Reads pictures of recipes through OpenImageIO; relative names are taken from `folder`.
CompileOptions recipe_options(const std::filesystem::path& folder);

/// Whether a name in a settings file is a recipe rather than a picture: a known type or recipe, alone or before a bar.
bool looks_like_recipe(const std::string& text, const RecipeLibrary& library);

/// Colours of [0, 1], three a texel, as a picture of 8 bits.
ColorImage to_color_image(const std::vector<float>& rgb, int width, int height);

}  // namespace papilla
