// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace papilla {

/// Recipes by name, and lists of colours by name.
///
/// A library file is text, one entry a line; a line that begins with a blank continues the one above:
///
///     # a comment
///     include more.recipes
///     colour fire = black, <1,0,0>, yellow, white
///     worn_brick   brick|scale=.5|mortarthickness=.08
///                  |mainfunction=this*[fbm|scale=.2]
///
/// Names hold letters, digits and _. and begin with a letter; names of base types and functions are reserved.
/// A later entry replaces an earlier one of the same name.
class RecipeLibrary {
 public:
  /// The recipes that come with the program: materials and ageing.
  static RecipeLibrary builtin();

  /// @throws InvalidInput when the name is none or taken.
  void add(const std::string& name, const std::string& recipe);
  /// @param colours  as a recipe's `cols` would have them.
  /// @throws InvalidInput when the name is none.
  void add_colours(const std::string& name, const std::string& colours);

  /// Reads a library file and what it includes.
  /// @throws IoError; InvalidInput naming file and line for a line that is no entry, a file over 16 MiB, and files that
  ///         include each other; InvalidInput as include().
  void read_file(const std::filesystem::path& path);

  /// The same for text; `source` names it in messages, `folder` is where includes are looked for.
  void read_text(std::string_view text, const std::string& source, const std::filesystem::path& folder);

  /// Reads a library file that another file names: one in the folder of that file or below it. What it holds may be
  /// no library at all, so messages do not quote it.
  /// @param place  in the other file, as messages begin.
  /// @throws InvalidInput as resolve_reference(); IoError when there is no such file; as read_file().
  void include(const std::string& name, const std::string& place, const std::filesystem::path& folder);

  const std::string* find(std::string_view name) const;
  const std::string* find_colours(std::string_view name) const;
  /// All files read, with includes, in the order of reading; also those that could not be read.
  const std::vector<std::filesystem::path>& files() const noexcept { return files_; }
  const std::map<std::string, std::string, std::less<>>& recipes() const noexcept { return recipes_; }
  const std::map<std::string, std::string, std::less<>>& colours() const noexcept { return colours_; }

 private:
  /// Whether messages quote the text.
  enum class Quotes { no, yes };
  void read_file(const std::filesystem::path& path, Quotes quotes);
  void read_text(std::string_view text, const std::string& source, const std::filesystem::path& folder, Quotes quotes);

  std::map<std::string, std::string, std::less<>> recipes_, colours_;
  std::vector<std::filesystem::path> files_, open_files_;
};

/// Names of recipes that suit a material of that name ("Leather black", "wood2"), best first; looks at the recipes'
/// names, idmaterial and idtype. Empty when none has anything in common.
std::vector<std::string> suggest_recipes(std::string_view material, const RecipeLibrary& library);

/// The recipe with its numbers changed by up to `strength` of themselves: parameters within the ranges of the table,
/// components of vectors (of a direction by up to strength/2 of its length), and numbers with a decimal point in
/// formulas. Colours, written out or named, change in OKLCh: all of one value by the same hue, up to 60° strength, and
/// the same factor of chroma, 1 ± strength; each by its own lightness, up to strength/4; chroma that sRGB does not have
/// is left out. limitlo and limithi, which must not cross, stay. Named recipes, lists of colours and layers are written
/// out and changed, too. Same seed, same recipe. @pre strength in [0, 1]. @throws InvalidInput when the text is no
/// recipe.
std::string mutate_recipe(std::string_view recipe, const RecipeLibrary& library, unsigned seed, double strength);

}  // namespace papilla
