// SPDX-License-Identifier: MIT
#include "papilla/pipeline/studio/studio_document.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "../json_value.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using Json = JsonValue::Json;

constexpr const char* k_materials = "materials";
constexpr const char* k_assign = "assign";
constexpr const char* k_decals = "decals";
constexpr const char* k_carriers = "replace";
constexpr const char* k_comment = "$comment";
constexpr const char* k_except = "not";
constexpr const char* k_material = "material";
constexpr int k_indent = 2;

Json selector_json(const SurfaceSelector& selector) {
  Json json = Json::object();
  for (const SelectorKey& key : selector_keys())
    if (const auto& pattern = selector.*key.pattern) json[std::string(key.name)] = *pattern;
  for (const SurfaceSelector& exception : selector.except) json[k_except].push_back(selector_json(exception));
  return json;
}

/// The names that selectors mean, for a material of these surfaces.
std::string shown_surfaces(const std::vector<SurfaceSelector>& surfaces) {
  if (surfaces.empty()) return {};
  std::string text;
  for (const SelectorKey& key : selector_keys())
    if (const auto& pattern = surfaces.front().*key.pattern) text += (text.empty() ? "" : ", ") + *pattern;
  std::erase(text, '\\');
  if (surfaces.size() > 1) text += " and " + std::to_string(surfaces.size() - 1) + " more";
  return text;
}

class Editor {
 public:
  Editor(const std::string& document, const StudioEdit& edit, const std::string& name)
      : edit_(edit), name_(name), json_(parse_json(document, name)) {
    require(json_.is_object(), "", "must be an object");
    if (!json_.contains(k_materials)) json_[k_materials] = Json::object();
    if (!json_.contains(k_assign)) json_[k_assign] = Json::array();
    require(materials().is_object(), "/materials", "must be an object");
    require(rules().is_array(), "/assign", "must be an array");
  }

  std::string run() {
    switch (edit_.kind) {
      case StudioEdit::Kind::assign: assign(edit_.material); break;
      case StudioEdit::Kind::vary: vary(); break;
      case StudioEdit::Kind::set: change(existing(edit_.material)); break;
      case StudioEdit::Kind::add: add(); break;
      case StudioEdit::Kind::remove: remove(); break;
      case StudioEdit::Kind::add_decal: add_to(k_decals); break;
      case StudioEdit::Kind::set_decal: change_picture(existing_of(k_decals)); break;
      case StudioEdit::Kind::remove_decal: remove_from(k_decals); break;
      case StudioEdit::Kind::add_carrier: add_to(k_carriers); break;
      case StudioEdit::Kind::set_carrier: change_picture(existing_of(k_carriers)); break;
      case StudioEdit::Kind::remove_carrier: remove_from(k_carriers); break;
    }
    return json_.dump(k_indent) + "\n";
  }

 private:
  Json& materials() { return json_[k_materials]; }
  Json& rules() { return json_[k_assign]; }

  void require(bool holds, const std::string& pointer, const std::string& reason) const {
    if (!holds) JsonValue(json_, name_, pointer).fail(reason);
  }

  Json& existing(const std::string& material) {
    require(materials().contains(material), "/materials", "there is no material '" + material + "'");
    return materials()[material];
  }

  /// The rule's own part that says what it is for.
  static Json without_material(Json rule) {
    if (rule.is_object()) rule.erase(k_material), rule.erase(k_comment);
    return rule;
  }

  void assign(const std::string& material) {
    if (!material.empty()) existing(material);
    std::vector<Json> wanted;
    for (const SurfaceSelector& surface : edit_.surfaces) wanted.push_back(selector_json(surface));
    std::vector<Json> kept;
    for (const Json& rule : rules()) {
      const Json selector = without_material(rule);
      if (std::find(wanted.begin(), wanted.end(), selector) == wanted.end()) kept.push_back(rule);
    }
    Json all = Json::array();
    for (Json& rule : wanted) {
      rule[k_material] = material.empty() ? Json(nullptr) : Json(material);
      all.push_back(std::move(rule));
    }
    for (Json& rule : kept) all.push_back(std::move(rule));
    rules() = std::move(all);
  }

  void change(Json& material) const {
    for (const auto& [pointer, text] : edit_.values) {
      const Json::json_pointer place = pointer_of(pointer);
      const Json value = parse_json(text, name_ + ": a value of " + pointer);
      if (!value.is_null()) {
        make_objects_above(material, place);
        material[place] = value;
        continue;
      }
      if (!material.contains(place)) continue;
      Json& above = material[place.parent_pointer()];
      if (above.is_object()) above.erase(place.back());
      if (above.is_object() && above.empty() && !place.parent_pointer().empty())
        material[place.parent_pointer().parent_pointer()].erase(place.parent_pointer().back());
    }
  }

  Json::json_pointer pointer_of(const std::string& text) const {
    try {
      Json::json_pointer place(text);
      require(!place.empty(), "", "a value has no place");
      return place;
    } catch (const Json::parse_error&) {
      throw InvalidInput(name_ + ": '" + text + "' is no JSON pointer");
    }
  }

  /// A word stands where keys are to go ("unwrap": "lscm"): it becomes the object's method.
  static void make_objects_above(Json& material, const Json::json_pointer& place) {
    const Json::json_pointer above = place.parent_pointer();
    if (above.empty()) return;
    Json& value = material[above];
    if (value.is_object()) return;
    value = value.is_string() && value != "auto" && value != "keep" && above.back() == "unwrap"
                ? Json{{"method", value}}
                : Json::object();
  }

  void vary() {
    const Json& original = existing(edit_.material);
    if (is_of_these_alone(edit_.material)) return change(existing(edit_.material));
    Json varied = original;
    varied[k_comment] = edit_.material + ", for " + shown_surfaces(edit_.surfaces);
    change(varied);
    const std::string name = free_name(edit_.material + " on " + shown_surfaces(edit_.surfaces));
    materials()[name] = std::move(varied);
    assign(name);
  }

  /// Whether rules for the edit's surfaces, and no others, assign the material.
  bool is_of_these_alone(const std::string& material) {
    std::vector<Json> found;
    for (const Json& rule : rules())
      if (rule.is_object() && rule.contains(k_material) && rule[k_material] == material)
        found.push_back(without_material(rule));
    if (found.size() != edit_.surfaces.size()) return false;
    return std::all_of(edit_.surfaces.begin(), edit_.surfaces.end(), [&](const SurfaceSelector& surface) {
      return std::find(found.begin(), found.end(), selector_json(surface)) != found.end();
    });
  }

  std::string free_name(const std::string& wanted) {
    std::string name = wanted;
    for (int i = 2; materials().contains(name); ++i) name = wanted + " " + std::to_string(i);
    return name;
  }

  void add() {
    require(!edit_.material.empty(), "/materials", "a material needs a name");
    require(!materials().contains(edit_.material), "/materials",
            "there is a material '" + edit_.material + "' already");
    Json material = Json::object();
    change(material);
    materials()[edit_.material] = std::move(material);
  }

  void remove() {
    existing(edit_.material);
    materials().erase(edit_.material);
    Json kept = Json::array();
    for (const Json& rule : rules())
      if (!rule.is_object() || !rule.contains(k_material) || rule[k_material] != edit_.material) kept.push_back(rule);
    rules() = std::move(kept);
  }

  // Lists of pictures on the scene.

  Json& existing_of(const char* list) {
    require(json_.contains(list) && json_[list].is_array() && edit_.number < json_[list].size() &&
                json_[list][edit_.number].is_object(),
            "", "there is no entry " + std::to_string(edit_.number) + " of '" + list + "'");
    return json_[list][edit_.number];
  }

  void change_picture(Json& entry) const {
    if (edit_.onto) {
      for (const SelectorKey& key : selector_keys()) entry.erase(std::string(key.name));
      entry.erase(k_except);
      entry.update(selector_json(*edit_.onto));
    }
    change(entry);
  }

  void add_to(const char* list) {
    if (!json_.contains(list)) json_[list] = Json::array();
    require(json_[list].is_array(), std::string("/") + list, "must be an array");
    Json entry = Json::object();
    change_picture(entry);
    json_[list].push_back(std::move(entry));
  }

  void remove_from(const char* list) {
    existing_of(list);
    json_[list].erase(edit_.number);
    if (json_[list].empty()) json_.erase(list);
  }

  const StudioEdit& edit_;
  const std::string& name_;
  Json json_;
};

}  // namespace

std::string empty_studio_document() {
  return Json{{k_materials, Json::object()}, {k_assign, Json::array()}}.dump(k_indent) + "\n";
}

std::string edited_document(const std::string& document, const StudioEdit& edit, const std::string& name) {
  try {
    return Editor(document, edit, name).run();
  } catch (const Json::exception& error) {
    throw InvalidInput(name + ": the change has no place there: " + error.what());
  }
}

StudioHistory::StudioHistory(std::string document) {
  steps_.push_back({std::make_shared<const std::string>(std::move(document)), {}});
}

void StudioHistory::add(std::string document, std::string title) {
  if (document == this->document()) return;
  steps_.resize(now_ + 1);
  steps_.push_back({std::make_shared<const std::string>(std::move(document)), std::move(title)});
  if (steps_.size() > k_most_steps) steps_.erase(steps_.begin());
  now_ = steps_.size() - 1;
}

}  // namespace papilla
