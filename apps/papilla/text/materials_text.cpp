// SPDX-License-Identifier: GPL-3.0-or-later
#include "text/materials_text.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "shown_format.hpp"

namespace papilla::app {
namespace {

std::string joined(const BilingualWords& words) {
  std::string line;
  for (const auto* list : {&words.en, &words.de})
    for (const std::string& word : *list) line += (line.empty() ? "" : ", ") + word;
  return line;
}

/// The unit of a number by its key.
std::string_view unit_of(std::string_view key) {
  if (key.ends_with("stiffness")) return "N/m";
  if (key == "damping") return "N·s/m";
  if (key == "stribeckVelocity") return "m/s";
  if (key == "youngsModulus") return "Pa";
  if (key == "roughness/rms" || key.starts_with("roughness/wavelength_range")) return "m";
  return key.ends_with("_mm") || key.find("_mm/") != std::string_view::npos ? "mm" : "";
}

std::string relief_line(const LibraryRelief& relief) {
  if (relief.grain) return shown_format("grain {}, seed {}", std::string(to_string(*relief.grain)), relief.seed);
  if (!relief.picture.empty())
    return shown_format("picture {}{}{}", relief.picture.string(), relief.process.empty() ? "" : ": ", relief.process);
  return shown_format("recipe {}", relief.recipe);
}

}  // namespace

std::string library_table(const std::vector<LibraryMaterial>& materials) {
  std::size_t width = 8;
  for (const LibraryMaterial& material : materials) width = std::max(width, material.id.size());
  std::string out = shown_format("{:<{}}  {:>6}  {:>11}  name\n", "material", width, "N/m", "friction");
  for (const LibraryMaterial& m : materials)
    out += shown_format("{:<{}}  {:>6}  {:>4} / {:<4}  {} · {}\n", m.id, width, m.stiffness.value,
                        m.static_friction.value, m.dynamic_friction.value, m.name_en, m.name_de);
  return out;
}

std::string library_material_text(const LibraryMaterial& material) {
  std::string out = shown_format("{}\n{} · {}\n", material.id, material.name_en, material.name_de);
  for (const auto& [what, words] : {std::pair{"also", &material.aliases}, std::pair{"category", &material.categories},
                                    std::pair{"used for", &material.uses}})
    if (const std::string line = joined(*words); !line.empty()) out += shown_format("{}: {}\n", what, line);
  if (material.relief) out += shown_format("relief: {}\n", relief_line(*material.relief));
  for (const LibraryNumber& number : numbers_of(material))
    out += shown_format("  {:<28} {:>14} {:<6} {}{}{}\n", number.key, number.value, unit_of(number.key),
                        number.source.empty() ? "estimated" : "[" + number.source + "]",
                        number.note.empty() ? "" : ": ", number.note);
  for (const auto& [key, citation] : material.sources) out += shown_format("[{}] {}\n", key, citation);
  return out;
}

std::string library_check_text(const LibraryCheck& check) {
  std::string out;
  for (const LibraryProblem& problem : check.problems) out += shown_format("{}\n", problem.reason);
  return out + shown_format("{} materials, {} with a problem; {} numbers cited, {} estimated\n",
                            check.materials + check.problems.size(), check.problems.size(), check.cited,
                            check.estimated);
}

std::string suggestions_text(const std::vector<MaterialSuggestion>& suggestions) {
  if (suggestions.empty()) return "";
  std::size_t width = 0;
  for (const MaterialSuggestion& suggestion : suggestions) width = std::max(width, suggestion.material.size());
  std::string out = "\nsuggested from the material library for surfaces without a material; nothing of it is applied\n";
  for (std::size_t i = 0; i < suggestions.size(); ++i) {
    const bool is_first = i == 0 || suggestions[i].surface != suggestions[i - 1].surface;
    out += shown_format("  {:<32}  library:{:<{}}  {}\n", is_first ? suggestions[i].surface : "",
                        suggestions[i].material, width, suggestions[i].reason);
  }
  return out;
}

}  // namespace papilla::app
