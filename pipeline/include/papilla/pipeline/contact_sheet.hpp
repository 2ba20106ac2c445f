// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "papilla/procedural/texture.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// What a contact sheet says of a recipe.
struct SheetEntry {
  std::string name, recipe;
  std::string text;                    ///< The library's entry of that name, else the recipe.
  std::vector<std::string> uses;       ///< Recipes of the library that it rests on.
  double low = 0, high = 0, mean = 0;  ///< Of the height.
  double seam = 0;    ///< Largest step across the border over the largest step within; about 1 where it tiles.
  std::string error;  ///< Why it has no picture.
};

struct ContactSheet {
  ColorImage picture;  ///< Tiles with shading, row by row in the order given.
  std::vector<SheetEntry> entries;
  int columns = 0;
};

/// Pictures of recipes side by side, colours lit by the height.
/// @pre side >= 8.
ContactSheet make_contact_sheet(const std::vector<std::pair<std::string, std::string>>& recipes,
                                const RecipeLibrary& library, const CompileOptions& options, int side);

/// Every type's name and the plainest recipe of it that shows something.
std::vector<std::pair<std::string, std::string>> examples_of_types();

/// The sheet as an HTML page: every tile above its name, cut out of the picture, and a table.
std::string sheet_page(const ContactSheet& sheet, const std::string& picture_file);

/// Colours lit from the upper left by the slopes of the height; `relief` is the depth in texels of a height of 1.
ColorImage shaded(const RenderedTexture& texture, double relief);

}  // namespace papilla
