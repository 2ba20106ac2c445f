// SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <cmath>

#include "noise.hpp"
#include "papilla/procedural/library.hpp"
#include "papilla/procedural/reference.hpp"
#include "syntax.hpp"

namespace papilla {
namespace {

using namespace procedural_detail;

constexpr int k_deepest = 16;

class Mutation {
 public:
  Mutation(const RecipeLibrary& library, unsigned seed, double strength)
      : library_(library), seed_(seed), strength_(strength) {}

  std::string recipe(Piece text, const Origin& origin, int depth) {
    const RecipeSyntax syntax = split_recipe(trimmed(text), origin);
    std::string out(syntax.head.text);
    const TypeInfo* type = find_type(syntax.head.text);
    if (const std::string* named = library_.find(syntax.head.text); !type && named && depth < k_deepest) {
      out = recipe({*named, 0}, {"recipe '" + out + "'", *named}, depth + 1);
      type = find_type(std::string_view(out).substr(0, out.find('|')));
    }
    if (!type) type = &texture_types().front();
    for (const Assignment& a : syntax.parameters)
      out += '|' + std::string(a.name.text) + '=' + value(find_parameter(*type, a.name.text), a.value, origin, depth);
    return out;
  }

 private:
  double changed(double number) {
    return number * (1 + strength_ * (2 * unit_number(mix_bits(++count_, 19, seed_)) - 1));
  }
  static std::string plain(double number) {
    char text[32];
    const auto [end, unused] = std::to_chars(text, text + sizeof text, number, std::chars_format::general, 6);
    return {text, end};
  }

  std::string value(const ParameterInfo* p, Piece text, const Origin& origin, int depth) {
    if (p && (p->kind == ParameterKind::number || p->kind == ParameterKind::integer)) return number(*p, text.text);
    if (p && (p->kind == ParameterKind::expression || p->kind == ParameterKind::colour)) return formula(text.text);
    if (p && p->kind == ParameterKind::textures && !text.text.empty()) return textures(text, origin, depth);
    return std::string(text.text);
  }

  std::string number(const ParameterInfo& p, std::string_view text) {
    const auto read = plain_number(text);
    if (!read) return std::string(text);
    const double v = changed(*read);
    return plain(std::clamp(p.kind == ParameterKind::integer ? std::round(v) : v, p.low, p.high));
  }

  /// Numbers with a decimal point, outside of inline textures; whole numbers may be counts.
  std::string formula(std::string_view text) {
    std::string out;
    int brackets = 0;
    for (std::size_t at = 0; at < text.size();) {
      brackets += text[at] == '[' ? 1 : text[at] == ']' ? -1 : 0;
      std::size_t end = at;
      while (end < text.size() && in_name(text[end])) ++end;
      const std::string_view word = text.substr(at, std::max<std::size_t>(end - at, 1));
      const auto number = plain_number(word);
      if (brackets == 0 && number && word.find('.') != std::string_view::npos)
        out += plain(changed(*number));
      else
        out += word;
      at += word.size();
    }
    return out;
  }

  std::string textures(Piece list, const Origin& origin, int depth) {
    std::string out;
    for (Piece piece : split_outside(list, ',', origin)) {
      if (piece.text.size() > 1 && piece.text.front() == '[' && piece.text.back() == ']')
        piece = trimmed({piece.text.substr(1, piece.text.size() - 2), piece.position + 1});
      if (!out.empty()) out += ',';
      out += depth < k_deepest ? '[' + recipe(piece, origin, depth + 1) + ']' : std::string(piece.text);
    }
    return out;
  }

  const RecipeLibrary& library_;
  unsigned seed_;
  double strength_;
  std::uint32_t count_ = 0;
};

}  // namespace

std::string mutate_recipe(std::string_view recipe, const RecipeLibrary& library, unsigned seed, double strength) {
  return Mutation(library, seed, strength).recipe({recipe, 0}, {"recipe", recipe}, 0);
}

}  // namespace papilla
