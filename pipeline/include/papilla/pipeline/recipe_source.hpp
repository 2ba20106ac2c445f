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

/// Options with which recipes may name pictures of any format that read_color_image() takes, in `folder` or below it.
CompileOptions recipe_options(const std::filesystem::path& folder);

/// Whether a text names a recipe rather than a file: a known type or recipe, alone or before a bar.
bool looks_like_recipe(const std::string& text, const RecipeLibrary& library);

/// Colours of [0, 1], three a texel, as a picture of 8 bits.
ColorImage to_color_image(const std::vector<float>& rgb, int width, int height);

}  // namespace papilla
