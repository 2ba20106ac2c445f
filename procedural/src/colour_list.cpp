// SPDX-License-Identifier: MIT
#include "colour_list.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace papilla::procedural_detail {
namespace {

constexpr int k_deepest = 16;

std::vector<Rgb> parse(Piece text, const Origin& origin, const RecipeLibrary& library, int depth);

std::optional<std::vector<Rgb>> named(std::string_view name, const RecipeLibrary& library, int depth) {
  if (const auto rgb = named_colour(name)) return std::vector<Rgb>{*rgb};
  const std::string* list = library.find_colours(name);
  if (!list || depth > k_deepest) return std::nullopt;
  return parse({*list, 0}, {"colour '" + std::string(name) + "'", *list}, library, depth + 1);
}

std::vector<Rgb> parse(Piece text, const Origin& origin, const RecipeLibrary& library, int depth) {
  std::vector<Rgb> out;
  std::size_t at = 0;
  const std::string_view s = text.text;
  while (at < s.size()) {
    if (s[at] == ' ' || s[at] == ',' || s[at] == '\t' || s[at] == '\n' || s[at] == '\r') {
      ++at;
      continue;
    }
    const std::size_t start = at;
    if (s[at] == '<') {
      Rgb rgb{};
      ++at;
      for (std::size_t k = 0; k < 3; ++k) {
        while (at < s.size() && s[at] == ' ') ++at;
        const auto [stop, error] = std::from_chars(s.data() + at, s.data() + s.size(), rgb[k]);
        if (error != std::errc() || !std::isfinite(rgb[k]))
          fail_at(origin, text.position + at, "expected a number of a colour <r,g,b>");
        at = static_cast<std::size_t>(stop - s.data());
        while (at < s.size() && s[at] == ' ') ++at;
        if (at >= s.size() || s[at] != (k < 2 ? ',' : '>'))
          fail_at(origin, text.position + at, std::string("expected '") + (k < 2 ? ',' : '>') + "' in the colour");
        ++at;
        rgb[k] = std::clamp(rgb[k], 0.0, 1.0);
      }
      out.push_back(rgb);
    } else {
      while (at < s.size() && s[at] != ',' && s[at] != ' ' && s[at] != '<') ++at;
      const auto list = named(s.substr(start, at - start), library, depth);
      if (!list)
        fail_at(origin, text.position + start,
                "unknown colour " + in_quotes(s.substr(start, at - start)) + "; expected a name or <r,g,b>");
      out.insert(out.end(), list->begin(), list->end());
    }
    if (out.size() > 4096) fail_at(origin, text.position, "more than 4096 colours");
  }
  if (out.empty()) fail_at(origin, text.position, "expected colours");
  return out;
}

}  // namespace

std::vector<Rgb> parse_colours(Piece text, const Origin& origin, const RecipeLibrary& library) {
  return parse(text, origin, library, 0);
}

std::optional<std::vector<Rgb>> colours_named(std::string_view name, const RecipeLibrary& library) {
  return named(name, library, 0);
}

}  // namespace papilla::procedural_detail
