// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "papilla/procedural/texture.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// Name and text of a recipe.
using NamedRecipe = std::pair<std::string, std::string>;

/// One recipe of a contact sheet.
struct SheetEntry {
  std::string name, recipe;
  std::string text;                    ///< The library's entry of that name, else the recipe.
  std::vector<std::string> uses;       ///< Recipes of the library that it is built from.
  double low = 0, high = 0, mean = 0;  ///< Of the height.
  double seam = 0;      ///< Largest step across the border over the largest step within; about 1 where it tiles.
  double exposure = 1;  ///< That its tile is brightened by, 1 to 3: dark materials show their structure, too.
  std::string error;    ///< Why it has no picture.
};

/// White pixels between the tiles and around them.
inline constexpr int k_sheet_gap_px = 4;

struct ContactSheet {
  ColorImage picture;  ///< Tiles with shading, row by row in the order given.
  std::vector<SheetEntry> entries;
  int columns = 0;
};

/// Pictures of recipes side by side, each in the light of its own recipe, dark ones brightened.
/// @pre side >= 8.
ContactSheet make_contact_sheet(const std::vector<NamedRecipe>& recipes, const RecipeLibrary& library,
                                const CompileOptions& options, int side, const ProgressCallback& progress = {});

/// A recipe for every texture type: its defaults, or the least that makes the type visible.
std::vector<NamedRecipe> examples_of_types();

/// Every recipe of the library; an ageing recipe on top of a material that it suits.
std::vector<NamedRecipe> examples_of_library(const RecipeLibrary& library);

/// Names of the library's recipes by their `idtype`; "none" for those without.
std::map<std::string, std::vector<std::string>> recipes_by_category(const RecipeLibrary& library);

}  // namespace papilla
