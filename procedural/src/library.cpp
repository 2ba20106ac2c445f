// SPDX-License-Identifier: MIT
#include "papilla/procedural/library.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "builtin_recipes.hpp"
#include "papilla/core/error.hpp"
#include "papilla/procedural/reference.hpp"
#include "syntax.hpp"

namespace papilla {
namespace {

using namespace procedural_detail;

constexpr std::uintmax_t k_most_file = std::uintmax_t{16} << 20;
constexpr std::size_t k_most_open = 32;

/// Entries of a file: continued lines joined, comments left out.
struct Entry {
  std::size_t line;
  std::string text;
};

std::vector<Entry> entries_of(std::string_view text) {
  std::vector<Entry> entries;
  std::size_t line_number = 0;
  while (!text.empty()) {
    ++line_number;
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(text.size(), end + 1));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    const Piece content = trimmed({line, 0});
    if (content.text.empty() || content.text.front() == '#') continue;
    if (content.position > 0 && !entries.empty())
      entries.back().text += content.text;
    else
      entries.push_back({line_number, std::string(content.text)});
  }
  return entries;
}

std::string lower_case(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return out;
}

/// The runs of letters of a name.
std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words(1);
  for (const char c : lower_case(text)) {
    if (c >= 'a' && c <= 'z')
      words.back() += c;
    else if (!words.back().empty())
      words.emplace_back();
  }
  std::erase(words, "");
  return words;
}

}  // namespace

RecipeLibrary RecipeLibrary::builtin() {
  RecipeLibrary library;
  library.read_text(k_builtin_recipes, "built-in recipes", {});
  return library;
}

void RecipeLibrary::add(const std::string& name, const std::string& recipe) {
  if (!is_name(name))
    throw InvalidInput("recipe library: " + in_quotes(name) +
                       " is no name; names hold letters, digits, _ and . and begin with a letter");
  const FunctionInfo* function = find_function(name);
  if (find_type(name) || (function && function->arity == 0))
    throw InvalidInput("recipe library: the name " + in_quotes(name) + " is taken by the language");
  recipes_.insert_or_assign(name, recipe);
}

void RecipeLibrary::add_colours(const std::string& name, const std::string& colours) {
  if (!is_name(name)) throw InvalidInput("recipe library: " + in_quotes(name) + " is no name");
  colours_.insert_or_assign(name, colours);
}

const std::string* RecipeLibrary::find(std::string_view name) const {
  const auto it = recipes_.find(name);
  return it == recipes_.end() ? nullptr : &it->second;
}

const std::string* RecipeLibrary::find_colours(std::string_view name) const {
  const auto it = colours_.find(name);
  return it == colours_.end() ? nullptr : &it->second;
}

void RecipeLibrary::read_file(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    throw IoError(path.string() + (std::filesystem::exists(path, error) ? ": is not a file" : ": does not exist"));
  if (const auto size = std::filesystem::file_size(path, error); error || size > k_most_file)
    throw InvalidInput(path.string() + ": a library of recipes has at most 16 MiB");
  const auto whole = std::filesystem::weakly_canonical(path, error);
  if (std::find(open_files_.begin(), open_files_.end(), whole) != open_files_.end())
    throw InvalidInput(path.string() + ": is included by itself");
  if (open_files_.size() >= k_most_open) throw InvalidInput(path.string() + ": more than 32 files include each other");
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw IoError(path.string() + ": cannot be read");
  open_files_.push_back(whole);
  try {
    read_text(text.str(), path.string(), path.parent_path());
  } catch (...) {
    open_files_.pop_back();
    throw;
  }
  open_files_.pop_back();
}

void RecipeLibrary::read_text(std::string_view text, const std::string& source, const std::filesystem::path& folder) {
  for (const Entry& entry : entries_of(text)) {
    const std::string place = source + ": line " + std::to_string(entry.line) + ": ";
    const std::size_t blank = entry.text.find_first_of(" \t");
    if (blank == std::string::npos)
      throw InvalidInput(place + "expected a name, a blank and a recipe, found " + in_quotes(entry.text));
    const std::string name = entry.text.substr(0, blank),
                      rest(trimmed({std::string_view(entry.text).substr(blank), 0}).text);
    if (name == "include") {
      read_file(folder / rest);
    } else if (name == "colour" || name == "color") {
      const std::size_t equals = rest.find('=');
      const std::string colour(trimmed({std::string_view(rest).substr(0, equals), 0}).text);
      if (equals == std::string::npos || !is_name(colour)) throw InvalidInput(place + "expected colour NAME = COLOURS");
      add_colours(colour, std::string(trimmed({std::string_view(rest).substr(equals + 1), 0}).text));
    } else {
      try {
        add(name, rest);
      } catch (const InvalidInput& refusal) {
        throw InvalidInput(place + refusal.what());
      }
    }
  }
}

std::vector<std::string> suggest_recipes(std::string_view material, const RecipeLibrary& library) {
  const std::vector<std::string> wanted = words_of(material);
  std::vector<std::pair<int, std::string>> ranked;
  for (const auto& [name, recipe] : library.recipes()) {
    std::string known = name;
    for (const std::string_view key : {"idmaterial=", "idtype="})
      if (const std::size_t at = recipe.find(key); at != std::string::npos)
        known += ' ' + recipe.substr(at + key.size(), recipe.find('|', at) - at - key.size());
    int score = 0;
    for (const std::string& word : words_of(known))
      score += static_cast<int>(std::count(wanted.begin(), wanted.end(), word));
    if (score > 0) ranked.emplace_back(-score, name);
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<std::string> names;
  for (auto& [score, name] : ranked) names.push_back(std::move(name));
  return names;
}

}  // namespace papilla
