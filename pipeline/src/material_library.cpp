// SPDX-License-Identifier: MIT
#include "papilla/pipeline/material_library.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <map>
#include <sstream>
#include <tuple>
#include <utility>

#include "papilla/core/near_name.hpp"
#include "papilla/pipeline/shared_data.hpp"

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

/// Endings of German adjectives: "weiches" is asked, "weich" is written.
constexpr std::array<std::string_view, 6> k_endings{"es", "er", "en", "em", "e", ""};
constexpr std::size_t k_letters_of_stem = 4;  ///< Fewer are within words by chance.

/// A word without the endings it may have, shortest last.
std::vector<std::string> forms_of(const std::string& word) {
  std::vector<std::string> forms{word};
  for (const std::string_view ending : k_endings)
    if (!ending.empty() && word.ends_with(ending) && word.size() >= ending.size() + k_letters_of_stem)
      forms.push_back(word.substr(0, word.size() - ending.size()));
  return forms;
}

bool has_form(const std::vector<std::string>& forms, std::string_view of) {
  return std::find(forms.begin(), forms.end(), of) != forms.end();
}

/// A word of a search. "soft" and "hard" are also said by the stiffness of a material.
struct SearchWord {
  std::vector<std::string> forms;
  bool is_soft, is_hard;
  bool is_known = false;  ///< A material has it, so that what is only near is something else.

  explicit SearchWord(const std::string& word)
      : forms(forms_of(word)),
        is_soft(has_form(forms, "soft") || has_form(forms, "weich")),
        is_hard(has_form(forms, "hard") || has_form(forms, "hart")) {}

  /// How much it says beside others: of "soft wood", wood.
  std::size_t letters() const { return is_soft || is_hard ? 1 : forms.front().size(); }
  bool is_in(const std::string& term) const {
    return std::any_of(forms.begin(), forms.end(),
                       [&](const std::string& form) { return term.find(form) != std::string::npos; });
  }
  bool is_near(const std::string& term) const {
    const std::vector<std::string> parts = words_of(term);
    return std::any_of(parts.begin(), parts.end(),
                       [&](const std::string& part) { return !did_you_mean(forms.front(), {part}).empty(); });
  }
  bool is_word_of(const std::string& term) const {
    const std::vector<std::string> parts = words_of(term);
    return std::any_of(parts.begin(), parts.end(), [&](const std::string& part) { return has_form(forms, part); });
  }
};

/// What a material is called, as it is compared.
struct FoldedTerms {
  std::vector<std::string> names, ids, categories, uses;
  double stiffness;

  explicit FoldedTerms(const LibraryMaterial& material) : stiffness(material.stiffness.value) {
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

  /// 3 where a name, the id or the stiffness has the word, 2 a category, 1 a use.
  /// @param near  whether a word of these need only be near.
  int score(const SearchWord& word, bool near) const {
    const auto any = [&](const std::vector<std::string>& terms) {
      return std::any_of(terms.begin(), terms.end(), [&](const std::string& term) {
        return word.is_in(term) || (near && !word.is_known && word.is_near(term));
      });
    };
    const bool is_soft = stiffness <= k_soft_stiffness;
    if ((word.is_soft && is_soft) || (word.is_hard && !is_soft)) return 3;
    return any(names) || any(ids) ? 3 : any(categories) ? 2 : any(uses) ? 1 : 0;
  }

  /// 2 where the word is a category, 1 where it is a whole word of a name: leather before what is like leather.
  /// "Soft" and "hard" are no kinds.
  int closeness(const SearchWord& word) const {
    if (word.is_soft || word.is_hard) return 0;
    const auto is_category = [&](const std::string& term) { return has_form(word.forms, term); };
    if (std::any_of(categories.begin(), categories.end(), is_category)) return 2;
    return std::any_of(names.begin(), names.end(), [&](const std::string& term) { return word.is_word_of(term); });
  }
};

/// The words of a search.
struct Search {
  std::string all;
  std::vector<SearchWord> words;
  std::size_t letters = 0;
  int softer_first = 0;  ///< 1 where "soft" is asked, -1 where "hard" is.

  explicit Search(std::string_view text) {
    for (const std::string& word : words_of(text)) {
      all += (all.empty() ? "" : " ") + word;
      words.emplace_back(word);
      letters += words.back().letters();
      softer_first += static_cast<int>(words.back().is_soft) - static_cast<int>(words.back().is_hard);
    }
  }
};

/// How well a material fits a search.
struct Rank {
  int score = 0;            ///< As MaterialHit::score.
  std::size_t letters = 0;  ///< Of the words that it has.
  int closeness = 0;        ///< Summed over the words.
};

/// @param part  whether words may be missing: the score is then the least of the others.
Rank rank_of(const FoldedTerms& terms, const Search& search, bool near, bool part) {
  Rank rank{.score = std::numeric_limits<int>::max()};
  for (const SearchWord& word : search.words) {
    const int score = terms.score(word, near);
    rank.closeness += terms.closeness(word);
    if (score > 0) rank.letters += word.letters();
    if (score > 0 || !part) rank.score = std::min(rank.score, score);
  }
  if (rank.letters == 0) return {};
  if (std::find(terms.names.begin(), terms.names.end(), search.all) != terms.names.end()) rank.score = 4;
  return rank;
}

}  // namespace

fs::path find_material_library() {
  if (const char* named = std::getenv("PAPILLA_MATERIAL_LIBRARY"); named != nullptr && *named != '\0') return named;
  return find_shared_data("materials", "PAPILLA_MATERIAL_LIBRARY may name one");
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
  Search search(words);
  std::vector<FoldedTerms> terms;
  for (const LibraryMaterial& material : materials) terms.emplace_back(material);
  for (SearchWord& word : search.words)
    word.is_known =
        std::any_of(terms.begin(), terms.end(), [&](const FoldedTerms& of) { return of.score(word, false) > 0; });
  struct Found {
    MaterialHit hit;
    Rank rank;
  };
  std::vector<Found> found;
  // All words as they are, then all or near ones, then the longer part of them.
  for (const auto& [near, part] : {std::pair{false, false}, std::pair{true, false}, std::pair{true, true}}) {
    for (std::size_t i = 0; i < materials.size(); ++i)
      if (const Rank rank = rank_of(terms[i], search, near, part); rank.score > 0 && 2 * rank.letters >= search.letters)
        found.push_back({{i, rank.score, near}, rank});
    if (!found.empty()) break;
  }
  std::stable_sort(found.begin(), found.end(), [&](const Found& a, const Found& b) {
    const auto order = [&](const Found& f) {
      return std::tuple{-static_cast<double>(f.rank.letters), -f.rank.score, -f.rank.closeness,
                        search.softer_first * terms[f.hit.material].stiffness};
    };
    return order(a) < order(b);
  });
  std::vector<MaterialHit> hits;
  for (const Found& f : found) hits.push_back(f.hit);
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
