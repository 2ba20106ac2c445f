// SPDX-License-Identifier: MIT
#include "syntax.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "papilla/core/one_line.hpp"
#include "papilla/procedural/recipe_error.hpp"

namespace papilla::procedural_detail {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

char closing(char open) { return open == '(' ? ')' : open == '[' ? ']' : '>'; }

/// Follows the brackets; only those in `kinds` count.
class Nesting {
 public:
  Nesting(std::string_view kinds, const Origin& origin) : kinds_(kinds), origin_(origin) {}
  bool outside() const { return open_.empty(); }
  void step(char c, std::size_t position) {
    if (kinds_.find(c) == std::string_view::npos) return;
    if (c == '(' || c == '[' || c == '<') {
      open_.push_back({closing(c), position});
      return;
    }
    if (open_.empty() || open_.back().close != c)
      fail_at(origin_, position,
              std::string("'") + c + "' closes nothing" +
                  (open_.empty() ? "" : std::string("; expected '") + open_.back().close + "'"));
    open_.pop_back();
  }
  void finish() const {
    if (!open_.empty())
      fail_at(origin_, open_.back().position,
              std::string("this bracket is never closed; expected '") + open_.back().close + "'");
  }

 private:
  struct Open {
    char close;
    std::size_t position;
  };
  std::string_view kinds_;
  const Origin& origin_;
  std::vector<Open> open_;
};

std::vector<Piece> split(Piece text, char separator, std::string_view kinds, const Origin& origin) {
  Nesting nesting(kinds, origin);
  std::vector<Piece> pieces;
  std::size_t start = 0;
  for (std::size_t i = 0; i < text.text.size(); ++i) {
    const char c = text.text[i];
    if (c == separator && nesting.outside()) {
      pieces.push_back(trimmed({text.text.substr(start, i - start), text.position + start}));
      start = i + 1;
    } else {
      nesting.step(c, text.position + i);
    }
  }
  nesting.finish();
  pieces.push_back(trimmed({text.text.substr(start), text.position + start}));
  return pieces;
}

}  // namespace

void fail_at(const Origin& origin, std::size_t position, const std::string& reason) {
  position = std::min(position, origin.whole.size());
  const std::string_view before = origin.whole.substr(0, position);
  const auto line = 1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
  const std::size_t start = before.rfind('\n');
  const std::size_t column = position - (start == std::string_view::npos ? 0 : start + 1) + 1;
  throw RecipeError(origin.name, position, line, column, reason);
}

Piece trimmed(Piece piece) {
  while (!piece.text.empty() && is_blank(piece.text.front())) {
    piece.text.remove_prefix(1);
    ++piece.position;
  }
  while (!piece.text.empty() && is_blank(piece.text.back())) piece.text.remove_suffix(1);
  return piece;
}

std::string in_quotes(std::string_view text) {
  return "'" + shown(text.substr(0, 40)) + (text.size() > 40 ? "...'" : "'");
}

bool in_name(char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '.'; }

bool is_name(std::string_view text) {
  return !text.empty() && text.size() <= 200 && is_letter(text.front()) &&
         std::all_of(text.begin(), text.end(), in_name);
}

std::optional<double> plain_number(std::string_view text) {
  double v = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), v);
  if (error != std::errc() || stop != text.data() + text.size() || !std::isfinite(v)) return std::nullopt;
  return v;
}

RecipeSyntax split_recipe(Piece recipe, const Origin& origin) {
  if (recipe.text.size() > k_most_text)
    fail_at(origin, recipe.position,
            "the recipe has " + std::to_string(recipe.text.size()) + " characters; at most " +
                std::to_string(k_most_text) + " are read");
  const std::vector<Piece> pieces = split(recipe, '|', "[]", origin);
  RecipeSyntax syntax;
  syntax.head = pieces.front();
  if (syntax.head.text.empty())
    fail_at(origin, syntax.head.position, "expected a texture type or the name of a recipe");
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const std::size_t equals = pieces[i].text.find('=');
    if (equals == std::string_view::npos)
      fail_at(origin, pieces[i].position, "expected name=value, found " + in_quotes(pieces[i].text));
    Assignment assignment{trimmed({pieces[i].text.substr(0, equals), pieces[i].position}),
                          trimmed({pieces[i].text.substr(equals + 1), pieces[i].position + equals + 1})};
    syntax.parameters.push_back(assignment);
  }
  return syntax;
}

std::vector<Piece> split_outside(Piece text, char separator, const Origin& origin) {
  return split(text, separator, "()[]<>", origin);
}

}  // namespace papilla::procedural_detail
