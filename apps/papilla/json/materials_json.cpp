// SPDX-License-Identifier: GPL-3.0-or-later
#include "json/materials_json.hpp"

#include <string>

namespace papilla::app {
namespace {

Json words_json(const BilingualWords& words) { return {{"en", words.en}, {"de", words.de}}; }

Json height_json(const LibraryRelief& relief) {
  Json json;
  if (!relief.recipe.empty()) json["recipe"] = relief.recipe;
  if (relief.grain) json["grain"] = {{"kind", to_string(*relief.grain)}, {"seed", relief.seed}};
  if (!relief.picture.empty()) json["picture"] = relief.picture.string();
  if (!relief.process.empty()) json["process"] = relief.process;
  json["size_mm"] = {relief.size_mm[0].value, relief.size_mm[1].value};
  json["depth_mm"] = relief.depth_mm.value;
  return json;
}

}  // namespace

Json library_material_json(const LibraryMaterial& material) {
  Json json{{"name", material.id},
            {"names", {{"en", material.name_en}, {"de", material.name_de}}},
            {"category", material.categories.en.front()},
            {"categories", words_json(material.categories)},
            {"aliases", Json::array()},
            {"uses", words_json(material.uses)},
            {"stiffness", material.stiffness.value},
            {"damping", material.damping.value},
            {"static_friction", material.static_friction.value},
            {"dynamic_friction", material.dynamic_friction.value},
            {"stribeck_velocity", material.stribeck_velocity.value},
            {"youngs_modulus", nullptr},
            {"backing", nullptr},
            {"height", nullptr},
            {"roughness", nullptr}};
  for (const auto* list : {&material.aliases.en, &material.aliases.de})
    for (const std::string& alias : *list) json["aliases"].push_back(alias);
  if (const auto& modulus = material.youngs_modulus) json["youngs_modulus"] = modulus->value;
  if (const auto& backing = material.backing)
    json["backing"] = {{"stiffness", backing->stiffness.value}, {"depth_mm", backing->depth_mm.value}};
  if (material.relief) json["height"] = height_json(*material.relief);
  if (const auto& roughness = material.roughness)
    json["roughness"] = {
        {"hurst", roughness->hurst.value},
        {"rms", roughness->rms_m.value},
        {"wavelength_range", {roughness->wavelength_range_m[0].value, roughness->wavelength_range_m[1].value}}};
  const LibraryAppearance& look = material.appearance;
  json["appearance"] = {
      {"color", look.color.value}, {"roughness", look.roughness.value}, {"metallic", look.metallic.value}};
  json["sources"] = json["notes"] = Json::object();
  for (const LibraryNumber& number : numbers_of(material)) {
    json["sources"][number.key] = number.source.empty() ? "estimated" : material.sources.at(number.source);
    if (!number.note.empty()) json["notes"][number.key] = number.note;
  }
  return json;
}

Json library_check_json(const LibraryCheck& check) {
  Json json{{"checked", check.materials + check.problems.size()},
            {"cited", check.cited},
            {"estimated", check.estimated},
            {"problems", Json::array()}};
  for (const LibraryProblem& problem : check.problems)
    json["problems"].push_back({{"file", problem.file}, {"reason", problem.reason}});
  return json;
}

Json suggestions_json(const std::vector<MaterialSuggestion>& suggestions) {
  Json json = Json::array();
  for (const MaterialSuggestion& suggestion : suggestions)
    json.push_back({{"part", suggestion.surface},
                    {"material", std::string(k_library_prefix) + suggestion.material},
                    {"reason", suggestion.reason}});
  return json;
}

}  // namespace papilla::app
