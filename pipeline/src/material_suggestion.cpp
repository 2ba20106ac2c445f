// SPDX-License-Identifier: MIT
#include "papilla/pipeline/material_suggestion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "papilla/core/vec.hpp"
#include "papilla/pipeline/hex_colour.hpp"
#include "papilla/pipeline/material_library.hpp"

namespace papilla {
namespace {

constexpr double k_near_colour = 10;         ///< ΔE*ab.
constexpr double k_least_chroma = 10;        ///< C*ab; what is greyer may be anything.
constexpr std::size_t k_letters_inside = 4;  ///< A shorter word within a longer one is chance.

using Words = std::vector<std::string>;

Words split(const std::string& text) {
  std::istringstream stream{folded(text)};
  Words words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// The words of a name: "SeatCushion_2" has seat and cushion.
Words words_of_name(const std::string& name) {
  std::string spaced;
  for (const char c : name) {
    const bool is_capital = c >= 'A' && c <= 'Z';
    if (is_capital && !spaced.empty() && spaced.back() >= 'a' && spaced.back() <= 'z') spaced += ' ';
    spaced += c;
  }
  return split(spaced);
}

bool matches(const std::string& word, const std::string& term) {
  if (word == term) return true;
  return term.size() >= k_letters_inside && (word.starts_with(term) || word.ends_with(term));
}

bool has(const Words& words, const std::string& term) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) { return matches(word, term); });
}

/// A term of a material: the words that must all be there, how it is written, and how much it says.
struct Term {
  Words words;
  std::string text;
  int weight;
};

/// CIE 1976 L*a*b* under D65 of "#rrggbb".
Vec3 lab_of(const std::string& hex) {
  const std::array<double, 4> c = linear_colour(hex);
  const double x = (0.4124564 * c[0] + 0.3575761 * c[1] + 0.1804375 * c[2]) / 0.95047;
  const double y = 0.2126729 * c[0] + 0.7151522 * c[1] + 0.0721750 * c[2];
  const double z = (0.0193339 * c[0] + 0.1191920 * c[1] + 0.9503041 * c[2]) / 1.08883;
  const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; };
  return {116 * f(y) - 16, 500 * (f(x) - f(y)), 200 * (f(y) - f(z))};
}

/// A material as it is compared.
struct Candidate {
  const LibraryMaterial* material;
  std::vector<Term> terms;
  Vec3 lab;

  explicit Candidate(const LibraryMaterial& of) : material(&of), lab(lab_of(of.appearance.color.value)) {
    for (const std::string& name : {of.name_en, of.name_de}) add(name, 3);
    for (const auto& [words, weight] :
         {std::pair{&of.aliases, 3}, std::pair{&of.categories, 2}, std::pair{&of.uses, 1}})
      for (const auto* list : {&words->en, &words->de})
        for (const std::string& term : *list) add(term, weight);
  }

  void add(const std::string& text, int weight) { terms.push_back({split(text), text, weight}); }
};

/// A name that a surface goes by.
struct Label {
  std::string what, name;
  int weight;  ///< A material's name says more than a part's.
  Words words;
};

std::vector<Label> labels_of(const SurfacePlace& place) {
  std::vector<Label> labels;
  const auto add = [&](const char* what, const std::vector<std::string>& names, int weight) {
    for (const std::string& name : names)
      if (!name.empty() && name.front() != '#') labels.push_back({what, name, weight, words_of_name(name)});
  };
  add("CAD material", place.cad_materials, 2);
  add("material", place.materials, 2);
  add("part name", place.parts, 1);
  add("mesh", place.meshes, 1);
  return labels;
}

struct Rating {
  int score = 0;
  std::string reason;
};

/// The best of a surface's names for a material: 0 where none has a term of it in full.
Rating rate(const std::vector<Label>& labels, const Candidate& candidate) {
  Rating best;
  for (const Label& label : labels)
    for (const Term& term : candidate.terms) {
      const bool has_all = std::all_of(term.words.begin(), term.words.end(),
                                       [&](const std::string& word) { return has(label.words, word); });
      if (!has_all || term.words.empty()) continue;
      const int score = 100 * label.weight + 10 * term.weight + static_cast<int>(term.words.size());
      if (score > best.score) best = {score, fmt::format("{} '{}' has '{}'", label.what, label.name, term.text)};
    }
  return best;
}

/// Colours that a file gives: those of CAD, or of a material that has no picture.
std::optional<std::string> colour_of(const Scene& scene, const PartSurface& surface) {
  const std::vector<std::uint32_t>& materials = scene.parts[surface.part].materials;
  if (surface.slot >= materials.size()) return std::nullopt;
  const Material& material = scene.materials[materials[surface.slot]];
  if (material.base_color_texture) return std::nullopt;
  return hex_colour(material.base_color);
}

}  // namespace

std::vector<MaterialSuggestion> suggest_materials(const Scene& scene, const std::vector<PartSurface>& surfaces,
                                                  const std::vector<LibraryMaterial>& library, std::size_t most) {
  std::vector<Candidate> candidates;
  for (const LibraryMaterial& material : library) candidates.emplace_back(material);
  std::map<std::pair<std::uint32_t, std::uint32_t>, SurfacePlace> place_of;
  for (SurfacePlace& place : surface_places(scene)) place_of.try_emplace({place.part, place.slot}, std::move(place));

  std::vector<MaterialSuggestion> suggestions;
  for (const PartSurface& surface : surfaces) {
    if (!surface.material.empty()) continue;
    const auto place = place_of.find({surface.part, surface.slot});
    if (place == place_of.end()) continue;
    const std::vector<Label> labels = labels_of(place->second);
    const std::optional<std::string> colour = colour_of(scene, surface);
    struct Rated {
      Rating rating;
      double distance = 0;
      const Candidate* candidate;
    };
    std::vector<Rated> rated;
    for (const Candidate& candidate : candidates)
      rated.push_back({rate(labels, candidate), colour ? norm(lab_of(*colour) - candidate.lab) : 0, &candidate});
    const bool has_hue = colour && std::hypot(lab_of(*colour).y, lab_of(*colour).z) >= k_least_chroma;
    const bool by_name = std::any_of(rated.begin(), rated.end(), [](const Rated& r) { return r.rating.score > 0; });
    std::erase_if(
        rated, [&](const Rated& r) { return by_name ? r.rating.score == 0 : !has_hue || r.distance >= k_near_colour; });
    std::stable_sort(rated.begin(), rated.end(), [](const Rated& a, const Rated& b) {
      return std::pair{-a.rating.score, a.distance} < std::pair{-b.rating.score, b.distance};
    });
    rated.resize(std::min(rated.size(), most));
    for (const Rated& r : rated)
      suggestions.push_back({surface.label, r.candidate->material->id,
                             by_name ? r.rating.reason
                                     : fmt::format("only its colour {} is near {}", *colour,
                                                   r.candidate->material->appearance.color.value)});
  }
  return suggestions;
}

}  // namespace papilla
