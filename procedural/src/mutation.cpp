// SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "colours.hpp"
#include "noise.hpp"
#include "oklab.hpp"
#include "papilla/procedural/library.hpp"
#include "papilla/procedural/reference.hpp"
#include "syntax.hpp"

namespace papilla {
namespace {

using namespace procedural_detail;

constexpr int k_deepest = 16;
/// Around colours of a list.
constexpr std::string_view k_between = ", \t\r\n", k_ends_name = ",< \t\r\n";

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
  /// In [-strength, strength).
  double step() { return strength_ * (2 * unit_number(mix_bits(++count_, 19, seed_)) - 1); }
  double changed(double number) {
    constexpr double k_least = 1e-3;  // No size vanishes.
    return number * std::max(1 + step(), k_least);
  }
  static std::string plain(double number) {
    char text[32];
    const auto [end, unused] = std::to_chars(text, text + sizeof text, number, std::chars_format::general, 6);
    return {text, end};
  }

  std::string value(const ParameterInfo* p, Piece text, const Origin& origin, int depth) {
    if (p && (p->name == "limitlo" || p->name == "limithi")) return std::string(text.text);  // They must not cross.
    if (p && (p->kind == ParameterKind::number || p->kind == ParameterKind::integer)) return number(*p, text.text);
    if (p && (p->kind == ParameterKind::expression || p->kind == ParameterKind::colour))
      return formula(text.text, p->kind == ParameterKind::colour);
    if (p && p->kind == ParameterKind::vector) return vector(*p, trimmed(text), origin);
    if (p && p->kind == ParameterKind::colours) return colours(text.text, palette_change());
    if (p && p->kind == ParameterKind::textures && !text.text.empty()) return textures(text, origin, depth);
    return std::string(text.text);
  }

  std::string number(const ParameterInfo& p, std::string_view text) {
    const auto read = plain_number(text);
    if (!read) return std::string(text);
    const double v = changed(*read);
    return plain(std::clamp(p.kind == ParameterKind::integer ? std::round(v) : v, p.low, p.high));
  }

  /// Each component by itself: of a direction by a share of its length, else by a share of the component.
  std::string vector(const ParameterInfo& p, Piece text, const Origin& origin) {
    if (text.text.size() < 2 || text.text.front() != '<' || text.text.back() != '>') return component(text.text, 0);
    const std::vector<Piece> parts =
        split_outside({text.text.substr(1, text.text.size() - 2), text.position + 1}, ',', origin);
    double length = 0;
    for (const Piece& part : parts) length = std::hypot(length, plain_number(part.text).value_or(0));
    const bool is_direction = p.preset.starts_with('<');  // Of others one number is the default.
    std::string out;
    for (const Piece& part : parts) out += (out.empty() ? "<" : ",") + component(part.text, is_direction ? length : 0);
    return out + ">";
  }

  /// @param length  of the direction that it is a component of; 0: it is none.
  std::string component(std::string_view text, double length) {
    constexpr double k_tilt = 0.5;  // The step is at most that of the length: it stays a direction.
    const auto read = plain_number(text);
    if (!read) return formula(text, false);
    return plain(length > 0 ? *read + k_tilt * step() * length : changed(*read));
  }

  /// Hue and chroma of all colours of one value change alike, so that a palette stays one.
  struct PaletteChange {
    double hue, chroma;
  };
  PaletteChange palette_change() {
    constexpr double k_hue = std::numbers::pi / 3;
    const double hue = k_hue * step();
    return {hue, 1 + step()};
  }

  std::string colour(const Rgb& rgb, const PaletteChange& change) {
    constexpr double k_lightness = 0.25;
    Oklch c = oklch_of(rgb);
    c.hue += change.hue, c.chroma *= change.chroma, c.lightness += k_lightness * step();
    const Rgb changed_rgb = srgb_of(c);
    std::string out;
    for (const double v : changed_rgb) out += (out.empty() ? "<" : ",") + plain(std::round(1e4 * v) / 1e4);
    return out + ">";
  }

  /// <r,g,b> of three numbers at the begin of a text, and its length there.
  static std::optional<std::pair<Rgb, std::size_t>> written_colour(std::string_view text) {
    const std::size_t end = text.find('>');
    if (text.empty() || text.front() != '<' || end == std::string_view::npos) return std::nullopt;
    Rgb rgb{};
    std::string_view rest = text.substr(1, end - 1);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t comma = k < 2 ? rest.find(',') : rest.size();
      if (comma == std::string_view::npos) return std::nullopt;
      const auto number = plain_number(trimmed({rest.substr(0, comma), 0}).text);
      if (!number) return std::nullopt;
      rgb[k] = std::clamp(*number, 0.0, 1.0);
      rest.remove_prefix(std::min(rest.size(), comma + 1));
    }
    return std::pair(rgb, end + 1);
  }

  /// A list: colours that are written out or named; lists of the library are written out.
  std::string colours(std::string_view text, const PaletteChange& change, int depth = 0) {
    std::string out;
    const auto add = [&](const std::string& one) { out += (out.empty() ? "" : ",") + one; };
    for (std::size_t at = text.find_first_not_of(k_between); at < text.size();
         at = text.find_first_not_of(k_between, at)) {
      if (const auto written = written_colour(text.substr(at))) {
        add(colour(written->first, change));
        at += written->second;
        continue;
      }
      const std::size_t end = std::min(text.find_first_of(k_ends_name, at + 1), text.size());
      const std::string_view name = text.substr(at, end - at);
      const std::string* list = depth < k_deepest ? library_.find_colours(name) : nullptr;
      if (const auto named = named_colour(name))
        add(colour(*named, change));
      else
        add(list ? colours(*list, change, depth + 1) : std::string(name));
      at = end;
    }
    return out;
  }

  /// Whether a word of a formula for colours is the name of one.
  std::optional<Rgb> colour_in_formula(std::string_view word) const {
    const FunctionInfo* function = find_function(word);
    if ((function && function->arity == 0) || find_type(word) || library_.find(word)) return std::nullopt;
    return named_colour(word);
  }

  /// Colours and numbers with a decimal point, outside of inline textures; whole numbers may be counts.
  /// @param named  names of colours count.
  std::string formula(std::string_view text, bool named) {
    std::string out;
    std::optional<PaletteChange> change;
    const auto changed_colour = [&](const Rgb& rgb) {
      if (!change) change = palette_change();
      return colour(rgb, *change);
    };
    int brackets = 0;
    for (std::size_t at = 0; at < text.size();) {
      brackets += text[at] == '[' ? 1 : text[at] == ']' ? -1 : 0;
      const auto written = brackets == 0 ? written_colour(text.substr(at)) : std::nullopt;
      if (written) {
        out += changed_colour(written->first);
        at += written->second;
        continue;
      }
      std::size_t end = at;
      while (end < text.size() && in_name(text[end])) ++end;
      const std::string_view word = text.substr(at, std::max<std::size_t>(end - at, 1));
      const auto number = plain_number(word);
      const auto rgb = brackets == 0 && named ? colour_in_formula(word) : std::nullopt;
      if (brackets == 0 && number && word.find('.') != std::string_view::npos)
        out += plain(changed(*number));
      else if (rgb)
        out += changed_colour(*rgb);
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
