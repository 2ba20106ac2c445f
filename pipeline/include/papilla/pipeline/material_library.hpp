// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/pipeline/library_material.hpp"

namespace papilla {

/// No material of a library has that id. The message names the id and near ones.
class UnknownMaterial : public InvalidInput {
 public:
  using InvalidInput::InvalidInput;
};

/// The folder of the material library: that which PAPILLA_MATERIAL_LIBRARY names, else share/papilla/materials beside
/// the folder of the running program, else the one that was installed with this library.
/// @throws IoError naming the places where there is none.
std::filesystem::path find_material_library();

/// A folder of materials, a JSON file each, in folders of any depth. Files are read when they are asked for.
class MaterialLibrary {
 public:
  /// @throws IoError when it is no folder that can be read.
  explicit MaterialLibrary(std::filesystem::path folder);

  const std::filesystem::path& folder() const { return folder_; }
  /// Of all files, ascending.
  const std::vector<std::string>& ids() const { return ids_; }

  /// @throws UnknownMaterial, and as read_library_material().
  LibraryMaterial material(const std::string& id) const;

  /// All materials in the order of ids(). @throws as read_library_material() for the first one that is wrong.
  std::vector<LibraryMaterial> materials() const;

 private:
  std::filesystem::path folder_;
  std::vector<std::string> ids_;
};

/// A word as it is compared: lower case, accents left out, ä or ae as a, ö or oe as o, ü or ue as u, ß as ss; what is
/// neither letter nor digit is a blank.
std::string folded(std::string_view text);

/// A material that a search found.
struct MaterialHit {
  std::size_t material = 0;  ///< Its place in the list.
  int score = 0;  ///< 4 where the search is a name or alias in full, 3 where a word is in part of these, the id or the
                  ///< stiffness, 2 of a category, 1 of a use; the least of all words that are found.
  bool is_near = false;  ///< Words are only near some of the material's, or missing.
};

/// The stiffness [N/m] up to which a material is "soft" in a search, and above which it is "hard": it yields as much as
/// the wall of rendered_stiffness().
inline constexpr double k_soft_stiffness = 1250;

/// The materials whose names, aliases, ids, categories or uses have all the words, in any language. Upper and lower
/// case, umlauts and their spellings and endings of German adjectives are alike; "soft", "weich", "hard" and "hart" are
/// had by stiffness, too. Where none has them all: those with near words (near_name.hpp) for words that no material
/// has, and where there is none either, those with words of at least half of the letters. The best first: by letters
/// found, score, words that are a category or a whole word of a name, then the softest where "soft" is asked, the
/// hardest where "hard" is, then in the order of the list. Cost: words of the search x words of the library.
std::vector<MaterialHit> search_materials(const std::vector<LibraryMaterial>& materials, std::string_view words);

/// What is wrong with a file.
struct LibraryProblem {
  std::string file, reason;
};

/// What a check of files found.
struct LibraryCheck {
  std::size_t materials = 0;             ///< Files without a problem.
  std::size_t cited = 0, estimated = 0;  ///< Their numbers.
  std::vector<LibraryProblem> problems;
};

/// Reads a file, or all files of a folder, as read_library_material() does, and counts where their numbers come from.
/// Two materials must not share a name. @throws IoError when there is nothing at the path.
LibraryCheck check_materials(const std::filesystem::path& path);

}  // namespace papilla
