// SPDX-License-Identifier: MIT
#include "papilla/pipeline/material_library.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <map>
#include <sstream>
#include <utility>

#include "papilla/core/near_name.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> ids_in(const fs::path& folder) {
  std::vector<std::string> ids;
  try {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
      if (entry.path().extension() == ".json" && entry.is_regular_file())
        ids.push_back(entry.path().lexically_relative(folder).replace_extension().generic_string());
  } catch (const fs::filesystem_error& error) {
    throw IoError(folder.string() + ": " + error.code().message());
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// UTF-8 of letters with accents, in lower and upper case, and what they are compared as.
constexpr std::array<std::pair<std::string_view, char>, 40> k_letters{{
    {"ä", 'a'}, {"Ä", 'a'}, {"ö", 'o'}, {"Ö", 'o'}, {"ü", 'u'}, {"Ü", 'u'}, {"à", 'a'}, {"À", 'a'},
    {"á", 'a'}, {"Á", 'a'}, {"â", 'a'}, {"Â", 'a'}, {"å", 'a'}, {"Å", 'a'}, {"ç", 'c'}, {"Ç", 'c'},
    {"è", 'e'}, {"È", 'e'}, {"é", 'e'}, {"É", 'e'}, {"ê", 'e'}, {"Ê", 'e'}, {"ë", 'e'}, {"Ë", 'e'},
    {"î", 'i'}, {"Î", 'i'}, {"ï", 'i'}, {"Ï", 'i'}, {"ñ", 'n'}, {"Ñ", 'n'}, {"ô", 'o'}, {"Ô", 'o'},
    {"ó", 'o'}, {"Ó", 'o'}, {"ù", 'u'}, {"Ù", 'u'}, {"û", 'u'}, {"Û", 'u'}, {"ú", 'u'}, {"Ú", 'u'},
}};

std::vector<std::string> words_of(std::string_view text) {
  std::istringstream stream{folded(text)};
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// What a material is called, as it is compared.
struct FoldedTerms {
  std::vector<std::string> names, ids, categories, uses;

  explicit FoldedTerms(const LibraryMaterial& material) {
    names = {folded(material.name_en), folded(material.name_de)};
    add(material.aliases, names);
    ids = {folded(material.id)};
    add(material.categories, categories);
    add(material.uses, uses);
  }

  static void add(const BilingualWords& words, std::vector<std::string>& terms) {
    for (const auto* list : {&words.en, &words.de})
      for (const std::string& word : *list) terms.push_back(folded(word));
  }

  /// @param has  whether a term has the word.
  template <class Has>
  int score(const Has& has) const {
    const auto any = [&](const std::vector<std::string>& terms) {
      return std::any_of(terms.begin(), terms.end(), has);
    };
    return any(names) || any(ids) ? 3 : any(categories) ? 2 : any(uses) ? 1 : 0;
  }
};

/// 4 where the whole search is a name; else the least score of its words.
int score_of(const FoldedTerms& terms, const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : " ") + word;
  if (std::find(terms.names.begin(), terms.names.end(), all) != terms.names.end()) return 4;
  int least = std::numeric_limits<int>::max();
  for (const std::string& word : words)
    least = std::min(least, terms.score([&](const std::string& term) { return term.find(word) != std::string::npos; }));
  return words.empty() ? 0 : least;
}

bool is_near(const std::string& word, const std::string& term) {
  const std::vector<std::string> parts = words_of(term);
  return std::any_of(parts.begin(), parts.end(),
                     [&](const std::string& part) { return !did_you_mean(word, {part}).empty(); });
}

int near_score(const FoldedTerms& terms, const std::vector<std::string>& words) {
  int least = std::numeric_limits<int>::max();
  for (const std::string& word : words)
    least = std::min(least, terms.score([&](const std::string& term) { return is_near(word, term); }));
  return words.empty() ? 0 : least;
}

}  // namespace

fs::path find_material_library() {
  std::vector<fs::path> places;
  if (const char* named = std::getenv("PAPILLA_MATERIAL_LIBRARY"); named != nullptr && *named != '\0') return named;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) places.push_back(program.parent_path().parent_path() / "share/papilla/materials");
  places.emplace_back(PAPILLA_INSTALLED_MATERIALS);
  std::string looked;
  for (const fs::path& place : places) {
    if (fs::is_directory(place, error)) return place;
    looked += (looked.empty() ? "" : ", ") + place.string();
  }
  throw IoError("no material library is found: looked for " + looked + "; PAPILLA_MATERIAL_LIBRARY may name one");
}

MaterialLibrary::MaterialLibrary(fs::path folder) : folder_(std::move(folder)), ids_(ids_in(folder_)) {}

LibraryMaterial MaterialLibrary::material(const std::string& id) const {
  if (std::binary_search(ids_.begin(), ids_.end(), id)) return read_library_material(folder_, folder_ / (id + ".json"));
  const std::vector<std::string_view> known(ids_.begin(), ids_.end());
  // Of a path the last name counts where the whole of it is near none.
  std::string near = did_you_mean(id, known);
  if (const auto slash = id.rfind('/'); near.empty() && slash != std::string::npos)
    near = did_you_mean(id.substr(slash + 1), known);
  throw UnknownMaterial("the library has no material '" + id + "'" + near);
}

std::vector<LibraryMaterial> MaterialLibrary::materials() const {
  std::vector<LibraryMaterial> materials;
  for (const std::string& id : ids_) materials.push_back(material(id));
  return materials;
}

std::string folded(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size();) {
    const auto starts = [&](std::string_view letter) { return text.substr(i, letter.size()) == letter; };
    const auto* const accented =
        std::find_if(k_letters.begin(), k_letters.end(), [&](const auto& letter) { return starts(letter.first); });
    if (accented != k_letters.end()) {
      plain += accented->second;
      i += accented->first.size();
    } else if (starts("ß") || starts("ẞ")) {
      plain += "ss";
      i += starts("ß") ? std::size_t{2} : std::size_t{3};
    } else {
      const char c = text[i++];
      const bool is_letter =
          (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || (static_cast<unsigned char>(c) & 0x80U);
      plain += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : is_letter ? c : ' ';
    }
  }
  std::string out;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    out += plain[i];
    const bool is_umlaut = plain[i] == 'a' || plain[i] == 'o' || plain[i] == 'u';
    if (is_umlaut && i + 1 < plain.size() && plain[i + 1] == 'e') ++i;
  }
  return out;
}

std::vector<MaterialHit> search_materials(const std::vector<LibraryMaterial>& materials, std::string_view words) {
  const std::vector<std::string> wanted = words_of(words);
  std::vector<FoldedTerms> terms;
  for (const LibraryMaterial& material : materials) terms.emplace_back(material);
  std::vector<MaterialHit> hits;
  for (const bool near : {false, true}) {
    for (std::size_t i = 0; i < materials.size(); ++i)
      if (const int score = near ? near_score(terms[i], wanted) : score_of(terms[i], wanted); score > 0)
        hits.push_back({i, score, near});
    if (!hits.empty()) break;
  }
  std::stable_sort(hits.begin(), hits.end(),
                   [](const MaterialHit& a, const MaterialHit& b) { return a.score > b.score; });
  return hits;
}

LibraryCheck check_materials(const fs::path& path) {
  std::error_code error;
  const bool is_folder = fs::is_directory(path, error);
  if (!is_folder && !fs::exists(path, error)) throw IoError(path.string() + ": does not exist");
  const fs::path folder = is_folder ? path : path.parent_path();
  std::vector<fs::path> files;
  if (is_folder)
    for (const std::string& id : ids_in(path)) files.push_back(path / (id + ".json"));
  else
    files.push_back(path);

  LibraryCheck check;
  std::map<std::string, std::string> id_of_name;
  for (const fs::path& file : files) {
    try {
      const LibraryMaterial material = read_library_material(folder, file);
      for (const std::string& name : {material.name_en, material.name_de})
        if (const auto [other, is_new] = id_of_name.try_emplace(folded(name), material.id);
            !is_new && other->second != material.id)
          throw InvalidInput(file.string() + ": at /names: '" + name + "' is a name of " + other->second + ", too");
      ++check.materials;
      for (const LibraryNumber& number : numbers_of(material))
        ++(number.source.empty() ? check.estimated : check.cited);
    } catch (const Error& problem) {
      check.problems.push_back({file.string(), problem.what()});
    }
  }
  return check;
}

}  // namespace papilla
