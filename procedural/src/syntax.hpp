// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace papilla::procedural_detail {

/// A recipe longer than this is refused.
inline constexpr std::size_t k_most_text = std::size_t{1} << 20;

/// A piece of a recipe and its position in the whole text.
struct Piece {
  std::string_view text;
  std::size_t position = 0;  ///< Of its first character in the whole text.
};

/// The text that positions count in, and its name in messages.
struct Origin {
  std::string name;
  std::string_view whole;
};

struct Assignment {
  Piece name, value;
};

/// type|name=value|…
struct RecipeSyntax {
  Piece head;
  std::vector<Assignment> parameters;
};

/// @throws RecipeError "recipe 'x': line 1, column 7: …".
[[noreturn]] void fail_at(const Origin& origin, std::size_t position, const std::string& reason);

/// Splits at the bars outside of brackets. @throws InvalidInput with position.
RecipeSyntax split_recipe(Piece recipe, const Origin& origin);

/// Splits at a separator outside of (), [] and <>. Pieces are trimmed; empty pieces are kept.
std::vector<Piece> split_outside(Piece text, char separator, const Origin& origin);

Piece trimmed(Piece piece);

/// The text in quotes for a message: one line, at most 40 characters.
std::string in_quotes(std::string_view text);

bool is_name(std::string_view text);

/// Whether a character may stand in a name or number.
bool in_name(char c);

/// The number that a text is, all of it; nothing when it is none.
std::optional<double> plain_number(std::string_view text);

}  // namespace papilla::procedural_detail
