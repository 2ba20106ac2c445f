// SPDX-License-Identifier: MIT
#include "papilla/procedural/recipe_completion.hpp"

#include <algorithm>
#include <set>

#include "compiler.hpp"
#include "syntax.hpp"

namespace papilla {
namespace {

using namespace procedural_detail;

/// What of a recipe stands before the cursor.
struct OpenTexture {
  enum class Part { head, name, value } part = Part::head;
  std::string_view head, name;
  std::size_t begin = 0;             ///< Of the part.
  std::set<std::string_view> given;  ///< Parameters that the texture has.
};

/// The texture that is written at the end of a text, those around it behind each other. Never empty.
std::vector<OpenTexture> open_textures(std::string_view before) {
  std::vector<OpenTexture> open(1);
  for (std::size_t at = 0; at < before.size(); ++at) {
    OpenTexture& texture = open.back();
    const auto part = [&] { return trimmed({before.substr(texture.begin, at - texture.begin), 0}).text; };
    switch (before[at]) {
      case '[':
        open.emplace_back();
        open.back().begin = at + 1;
        break;
      case ']':
        if (open.size() > 1) open.pop_back();
        break;
      case '|':
        if (texture.part == OpenTexture::Part::head) texture.head = part();
        texture.part = OpenTexture::Part::name;
        texture.begin = at + 1;
        break;
      case '=':
        if (texture.part != OpenTexture::Part::name) break;
        texture.name = part();
        texture.given.insert(texture.name);
        texture.part = OpenTexture::Part::value;
        texture.begin = at + 1;
        break;
      default: break;
    }
  }
  return open;
}

class Completer {
 public:
  Completer(std::string_view letters, const RecipeLibrary& library) : letters_(letters), library_(library) {}

  std::vector<Completion> run(const OpenTexture& texture) {
    const TypeInfo* type = find_type(bottom_type(texture.head, library_));
    switch (texture.part) {
      case OpenTexture::Part::head: add_textures(); break;
      case OpenTexture::Part::name:
        if (type) add_parameters(*type, texture.given);
        break;
      case OpenTexture::Part::value:
        if (const ParameterInfo* info = type ? find_parameter(*type, texture.name) : nullptr) add_values(*info);
        break;
    }
    std::stable_partition(found_.begin(), found_.end(),
                          [&](const Completion& c) { return c.name.starts_with(letters_); });
    return std::move(found_);
  }

 private:
  void add(CompletionKind kind, std::string_view name, std::string_view behind, std::string_view note) {
    if (name.find(letters_) == std::string_view::npos || name == letters_) return;
    found_.push_back({kind, std::string(name), std::string(name) + std::string(behind), std::string(note)});
  }

  void sort_from(std::size_t first) {
    std::stable_sort(found_.begin() + static_cast<std::ptrdiff_t>(first), found_.end(),
                     [](const Completion& a, const Completion& b) { return a.name < b.name; });
  }

  void add_textures() {
    const std::size_t first = found_.size();
    for (const TypeInfo& type : texture_types()) add(CompletionKind::type, type.name, "", type.note);
    for (const auto& [name, recipe] : library_.recipes()) add(CompletionKind::recipe, name, "", recipe);
    sort_from(first);
  }

  void add_parameters(const TypeInfo& type, const std::set<std::string_view>& given) {
    const auto add_all = [&](std::span<const ParameterInfo> parameters) {
      for (const ParameterInfo& p : parameters)
        if (p.refusal.empty() && !given.contains(p.name) && find_parameter(type, p.name) == &p)
          add(CompletionKind::parameter, p.name, "=", p.note);
    };
    add_all(type.parameters);
    sort_from(0);
    const std::size_t first = found_.size();
    add_all(common_parameters());
    sort_from(first);
  }

  void add_values(const ParameterInfo& info) {
    switch (info.kind) {
      case ParameterKind::flag:
        add(CompletionKind::word, "false", "", info.note);
        add(CompletionKind::word, "true", "", info.note);
        break;
      case ParameterKind::choice: add_words(info.note); break;
      case ParameterKind::colours: add_colours(); break;
      case ParameterKind::textures: add_textures(); break;
      case ParameterKind::number:
      case ParameterKind::integer:
      case ParameterKind::vector: add_functions(); break;
      case ParameterKind::expression:
      case ParameterKind::colour:
        add_functions();
        add_textures();
        add_colours();
        sort_from(0);
        break;
      case ParameterKind::text: break;
    }
  }

  void add_words(std::string_view words) {
    while (!words.empty()) {
      const std::string_view word = words.substr(0, words.find(' '));
      add(CompletionKind::word, word, "", "");
      words.remove_prefix(std::min(words.size(), word.size() + 1));
    }
  }

  void add_functions() {
    for (const FunctionInfo& f : expression_functions())
      add(f.arity == 0 ? CompletionKind::variable : CompletionKind::function, f.name, f.arity == 0 ? "" : "(", f.note);
  }

  void add_colours() {
    for (const std::string_view name : colour_names()) add(CompletionKind::colour, name, "", "");
    for (const auto& [name, list] : library_.colours()) add(CompletionKind::colour, name, "", list);
    sort_from(0);
  }

  std::string_view letters_;
  const RecipeLibrary& library_;
  std::vector<Completion> found_;
};

}  // namespace

std::string_view to_string(CompletionKind kind) noexcept {
  switch (kind) {
    case CompletionKind::type: return "type";
    case CompletionKind::recipe: return "recipe";
    case CompletionKind::parameter: return "parameter";
    case CompletionKind::function: return "function";
    case CompletionKind::variable: return "variable";
    case CompletionKind::colour: return "colour";
    case CompletionKind::word: return "word";
  }
  return "";
}

Completions complete_recipe(std::string_view text, std::size_t cursor, const RecipeLibrary& library) {
  cursor = std::min(cursor, text.size());
  TextSpan word{cursor, cursor};
  while (word.begin > 0 && in_name(text[word.begin - 1])) --word.begin;
  while (word.end < text.size() && in_name(text[word.end])) ++word.end;
  const std::string_view letters = text.substr(word.begin, cursor - word.begin);
  Completions found{word, {}};
  if (!letters.empty() && letters.front() >= '0' && letters.front() <= '9') return found;
  found.all = Completer(letters, library).run(open_textures(text.substr(0, word.begin)).back());
  if (word.end < text.size())
    for (Completion& c : found.all)
      if (c.insert.size() > c.name.size() && c.insert.back() == text[word.end]) c.insert = c.name;
  return found;
}

}  // namespace papilla
