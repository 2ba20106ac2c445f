// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "colours.hpp"
#include "papilla/procedural/library.hpp"
#include "syntax.hpp"

namespace papilla::procedural_detail {

/// Colours by name and as <r,g,b>, separated by commas or blanks; lists of the library by their names.
/// @throws InvalidInput naming the position of what is no colour.
std::vector<Rgb> parse_colours(Piece text, const Origin& origin, const RecipeLibrary& library);

/// The colour of that name, or the library's list; nothing when there is none.
std::optional<std::vector<Rgb>> colours_named(std::string_view name, const RecipeLibrary& library);

}  // namespace papilla::procedural_detail
