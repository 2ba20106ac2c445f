// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/procedural/recipe_outline.hpp"

namespace papilla {

enum class CompletionKind { type, recipe, parameter, function, variable, colour, word };
std::string_view to_string(CompletionKind kind) noexcept;

struct Completion {
  CompletionKind kind = CompletionKind::word;
  std::string name;
  std::string insert;  ///< What is written: the name, with = or ( behind it where that must follow and is not there.
  std::string note;    ///< What the tables of reference.hpp say of it; of a recipe its text.
};

struct Completions {
  TextSpan word;  ///< What is replaced.
  std::vector<Completion> all;
};

/// What may stand at the cursor of a recipe that is being written: types and recipes at a head and in lists of
/// textures, parameters of the type behind a bar, in a value what its kind takes: true and false, the words of a
/// choice, colours, and in formulas functions, variables, recipes and colours. First those that begin with the letters
/// before the cursor, then those that hold them, each in alphabetical order; a parameter of the type before those of
/// all types. Parameters that are refused and those that the texture has already are left out. The text need not be
/// right, and what stands behind the word is not looked at. Cost: O(text + tables).
/// @param cursor  in bytes. @pre at most the text's length; beyond it counts as the end.
Completions complete_recipe(std::string_view text, std::size_t cursor, const RecipeLibrary& library);

}  // namespace papilla
