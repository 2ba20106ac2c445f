// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/procedural/library.hpp"
#include "papilla/procedural/reference.hpp"

namespace papilla {

/// Bytes [begin, end) of a text.
struct TextSpan {
  std::size_t begin = 0, end = 0;
  std::string_view of(std::string_view text) const { return text.substr(begin, end - begin); }
  friend bool operator==(const TextSpan&, const TextSpan&) = default;
};

/// A number that is written out.
struct OutlineNumber {
  TextSpan at;
  double value = 0;
};

/// A colour that is written out, as <r,g,b> or by a name of X11.
struct OutlineColour {
  TextSpan at;
  std::array<double, 3> rgb{};  ///< In [0, 1].
};

/// name=value.
struct OutlineParameter {
  TextSpan name, value;
  const ParameterInfo* info = nullptr;  ///< Null: the type has no parameter of that name.
  /// In the order of the text, without those of inline textures. Of a formula a minus is part of a number only where
  /// the value, a bracket or an argument begins.
  std::vector<OutlineNumber> numbers;
  std::vector<OutlineColour> colours;
};

/// A texture within a recipe's text: the whole, an entry of a list of textures, or a [recipe] of a formula.
struct OutlineTexture {
  TextSpan text;          ///< The recipe.
  TextSpan item;          ///< The same with its brackets, where it has any.
  TextSpan head;          ///< The name of its type or recipe.
  std::string_view type;  ///< The base type that the head comes down to; empty: there is none of that name.
  std::vector<OutlineParameter> parameters;
  std::optional<std::size_t> parent;  ///< Its number in the outline; none: this is the whole.
  std::size_t parameter = 0;          ///< The parent's parameter in which it stands.
  bool in_list = false;               ///< An entry of a list: a layer that may be moved.
};

/// The textures that a text writes out, each before those within it. Recipes that are only named are not opened.
/// Cost: O(text). @throws RecipeError where the text can't be taken apart: brackets, bars, equals signs, more than 32
/// levels. Whether names and values mean something is compile_texture()'s affair.
std::vector<OutlineTexture> outline_recipe(std::string_view text, const RecipeLibrary& library);

/// The text with a layer taken from its place and put before or behind another one, be it of another list.
/// All else stays as it was written.
/// @param layer, other  numbers in outline_recipe(). @throws InvalidInput when one of them is no layer, `other` lies
/// within `layer`, or it is the only one of its list, which would be empty; as outline_recipe().
std::string move_layer(std::string_view text, const RecipeLibrary& library, std::size_t layer, std::size_t other,
                       bool behind);

/// The text with [recipe] before or behind a layer; beside the whole, number 0, it becomes
/// multi|textures=[text],[recipe].
/// @throws InvalidInput when `other` is neither; as outline_recipe().
std::string insert_layer(std::string_view text, const RecipeLibrary& library, std::size_t other, bool behind,
                         std::string_view recipe);

/// The text without a layer. @throws as move_layer().
std::string remove_layer(std::string_view text, const RecipeLibrary& library, std::size_t layer);

}  // namespace papilla
