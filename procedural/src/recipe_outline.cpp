// SPDX-License-Identifier: MIT
#include "papilla/procedural/recipe_outline.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "compiler.hpp"
#include "papilla/core/error.hpp"
#include "syntax.hpp"

namespace papilla {
namespace {

using namespace procedural_detail;

constexpr std::size_t k_deepest = 32;

TextSpan span_of(Piece piece) { return {piece.position, piece.position + piece.text.size()}; }

/// Whether a minus at `at` belongs to the number behind it, as the value, a bracket or an argument begins there.
bool begins_number(std::string_view text, std::size_t at) {
  while (at > 0 && (text[at - 1] == ' ' || text[at - 1] == '\n')) --at;
  return at == 0 || std::string_view("(,<:").find(text[at - 1]) != std::string_view::npos;
}

class Outline {
 public:
  Outline(std::string_view text, const RecipeLibrary& library)
      : text_(text), library_(library), origin_{"recipe", text} {}

  std::vector<OutlineTexture> run() {
    texture(trimmed({text_, 0}), trimmed({text_, 0}), {});
    return std::move(all_);
  }

 private:
  /// Where a texture stands.
  struct Place {
    std::optional<std::size_t> parent = {};
    std::size_t parameter = 0, depth = 0;
    bool in_list = false;
  };

  void texture(Piece recipe, Piece item, Place place) {
    if (place.depth > k_deepest)
      fail_at(origin_, recipe.position, "textures are nested more than " + std::to_string(k_deepest) + " deep");
    const RecipeSyntax syntax = split_recipe(recipe, origin_);
    const std::size_t number = all_.size();
    const std::string_view base = bottom_type(syntax.head.text, library_);
    all_.push_back(
        {span_of(recipe), span_of(item), span_of(syntax.head), base, {}, place.parent, place.parameter, place.in_list});
    const TypeInfo* type = find_type(base);
    for (const Assignment& a : syntax.parameters) {
      const ParameterInfo* info = type ? find_parameter(*type, a.name.text) : nullptr;
      all_[number].parameters.push_back({span_of(a.name), span_of(a.value), info, {}, {}});
      value(a.value, {number, all_[number].parameters.size() - 1, place.depth + 1, false});
    }
  }

  OutlineParameter& parameter(const Place& place) { return all_[*place.parent].parameters[place.parameter]; }

  void value(Piece text, Place place) {
    const ParameterInfo* info = parameter(place).info;
    const ParameterKind kind = info ? info->kind : ParameterKind::text;
    switch (kind) {
      case ParameterKind::textures: textures(text, place); break;
      case ParameterKind::colours: formula(text, place, true); break;
      case ParameterKind::number:
      case ParameterKind::integer:
      case ParameterKind::vector: formula(text, place, false); break;
      case ParameterKind::expression:
      case ParameterKind::colour: formula(text, place, kind == ParameterKind::colour); break;
      case ParameterKind::text:
        if (info && info->name == "timemodifiers") formula(text, place, false);
        break;
      case ParameterKind::flag:
      case ParameterKind::choice: break;
    }
  }

  void textures(Piece list, Place place) {
    place.in_list = true;
    for (const Piece& piece : split_outside(list, ',', origin_))
      if (!piece.text.empty()) texture(without_brackets(piece), piece, place);
  }

  static Piece without_brackets(Piece piece) {
    const bool has = piece.text.size() > 1 && piece.text.front() == '[' && piece.text.back() == ']';
    return has ? trimmed({piece.text.substr(1, piece.text.size() - 2), piece.position + 1}) : piece;
  }

  /// Numbers, colours and inline textures. @param named  names of colours count.
  void formula(Piece text, Place place, bool named) {
    const std::string_view s = text.text;
    for (std::size_t at = 0; at < s.size();) {
      if (s[at] == '[') {
        const std::size_t end = closing_bracket(s, at);
        const Piece item{s.substr(at, end - at), text.position + at};
        texture(without_brackets(item), item, place);
        at = end;
      } else if (const std::size_t end = s[at] == '<' ? colour(text, at, place) : at; end > at) {
        at = end;
      } else {
        at = word(text, at, place, named);
      }
    }
  }

  static std::size_t closing_bracket(std::string_view s, std::size_t at) {
    int open = 0;
    for (; at < s.size(); ++at) {
      open += s[at] == '[' ? 1 : s[at] == ']' ? -1 : 0;
      if (open == 0) return at + 1;
    }
    return at;
  }

  /// <r,g,b> of three numbers. @returns where it ends; `at` when it is none.
  std::size_t colour(Piece text, std::size_t at, const Place& place) {
    const std::size_t end = text.text.find('>', at);
    if (parameter(place).info->kind == ParameterKind::vector || end == std::string_view::npos) return at;
    OutlineColour found{{text.position + at, text.position + end + 1}, {}};
    Piece rest{text.text.substr(at + 1, end - at - 1), 0};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t comma = k < 2 ? rest.text.find(',') : rest.text.size();
      if (comma == std::string_view::npos) return at;
      const auto number = plain_number(trimmed({rest.text.substr(0, comma), 0}).text);
      if (!number) return at;
      found.rgb[k] = std::clamp(*number, 0.0, 1.0);
      rest.text.remove_prefix(std::min(rest.text.size(), comma + 1));
    }
    parameter(place).colours.push_back(found);
    return end + 1;
  }

  /// A number, or the name of a colour where those count. @returns where it ends.
  std::size_t word(Piece text, std::size_t at, const Place& place, bool named) {
    const std::string_view s = text.text;
    const std::size_t first = s[at] == '-' && begins_number(s, at) ? at + 1 : at;
    if (first < s.size() && (s[first] == '.' || (s[first] >= '0' && s[first] <= '9'))) {
      double value = 0;
      const auto [stop, error] = std::from_chars(s.data() + at, s.data() + s.size(), value);
      const auto end = static_cast<std::size_t>(stop - s.data());
      if (error != std::errc() || !std::isfinite(value)) return first + 1;
      parameter(place).numbers.push_back({{text.position + at, text.position + end}, value});
      return end;
    }
    std::size_t end = at;
    while (end < s.size() && in_name(s[end])) ++end;
    const std::string_view name = s.substr(at, end - at);
    if (const auto rgb = named_colour(name); rgb && named && !is_other(name, place))
      parameter(place).colours.push_back({{text.position + at, text.position + end}, *rgb});
    return std::max(end, at + 1);
  }

  /// Whether a colour's name means something else in a formula.
  bool is_other(std::string_view name, const Place& place) {
    if (parameter(place).info->kind == ParameterKind::colours) return false;
    const FunctionInfo* function = find_function(name);
    return (function && function->arity == 0) || !bottom_type(name, library_).empty();
  }

  std::string_view text_;
  const RecipeLibrary& library_;
  const Origin origin_;
  std::vector<OutlineTexture> all_;
};

const OutlineTexture& layer_of(const std::vector<OutlineTexture>& outline, std::size_t number) {
  if (number >= outline.size() || !outline[number].in_list)
    throw InvalidInput("texture " + std::to_string(number) + " of the recipe is no layer");
  return outline[number];
}

/// The layer with the comma that goes with it: the one behind it, or of the last one the one before.
TextSpan with_comma(std::string_view text, const std::vector<OutlineTexture>& outline, const OutlineTexture& layer) {
  const auto beside = [&](const OutlineTexture& other) {
    return other.in_list && other.parent == layer.parent && other.parameter == layer.parameter;
  };
  if (std::count_if(outline.begin(), outline.end(), beside) < 2)
    throw InvalidInput("'" + std::string(layer.head.of(text)) + "' is the only layer of its list");
  const TextSpan list = outline[*layer.parent].parameters[layer.parameter].value;
  const std::size_t behind = text.find_first_not_of(" \t\r\n", layer.item.end);
  if (behind < list.end && text[behind] == ',')
    return {layer.item.begin, std::min(text.find_first_not_of(" \t\r\n", behind + 1), list.end)};
  return {text.rfind(',', layer.item.begin), layer.item.end};
}

}  // namespace

std::vector<OutlineTexture> outline_recipe(std::string_view text, const RecipeLibrary& library) {
  return Outline(text, library).run();
}

std::string move_layer(std::string_view text, const RecipeLibrary& library, std::size_t layer, std::size_t other,
                       bool behind) {
  const std::vector<OutlineTexture> outline = outline_recipe(text, library);
  const OutlineTexture &moved = layer_of(outline, layer), &mark = layer_of(outline, other);
  if (mark.item.begin >= moved.item.begin && mark.item.end <= moved.item.end) {
    if (layer == other) return std::string(text);
    throw InvalidInput("'" + std::string(moved.head.of(text)) + "' can't be moved into itself");
  }
  const TextSpan gap = with_comma(text, outline, moved);
  const std::string item(moved.item.of(text)), with_separator = behind ? "," + item : item + ",";
  std::string changed(text);
  const std::size_t at = behind ? mark.item.end : mark.item.begin;
  changed.insert(at, with_separator);
  changed.erase(gap.begin + (at <= gap.begin ? with_separator.size() : 0), gap.end - gap.begin);
  return changed;
}

std::string insert_layer(std::string_view text, const RecipeLibrary& library, std::size_t other, bool behind,
                         std::string_view recipe) {
  const std::vector<OutlineTexture> outline = outline_recipe(text, library);
  const std::string item = "[" + std::string(recipe) + "]";
  if (other == 0) {
    const std::string whole = "[" + std::string(outline.front().text.of(text)) + "]";
    return "multi|textures=" + (behind ? whole + "," + item : item + "," + whole);
  }
  const TextSpan mark = layer_of(outline, other).item;
  std::string changed(text);
  changed.insert(behind ? mark.end : mark.begin, behind ? "," + item : item + ",");
  return changed;
}

std::string remove_layer(std::string_view text, const RecipeLibrary& library, std::size_t layer) {
  const std::vector<OutlineTexture> outline = outline_recipe(text, library);
  const TextSpan gap = with_comma(text, outline, layer_of(outline, layer));
  std::string changed(text);
  changed.erase(gap.begin, gap.end - gap.begin);
  return changed;
}

}  // namespace papilla
