// SPDX-License-Identifier: MIT
#include "papilla/pipeline/library_material.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "json_value.hpp"
#include "papilla/core/plain_number.hpp"
#include "papilla/core/referenced_file.hpp"
#include "papilla/core/units.hpp"

namespace papilla {
namespace {

/// Reads values with their sources and notes which sources are named.
class SourcedReader {
 public:
  explicit SourcedReader(const std::map<std::string, std::string>& sources) : sources_(sources) {}

  SourcedNumber number(const JsonValue& value, double low, double high) {
    SourcedNumber number;
    number.value = origin(value, number).number(low, high);
    return number;
  }

  Sourced<std::string> colour(const JsonValue& value) {
    Sourced<std::string> colour;
    colour.value = origin(value, colour).hex_colour();
    return colour;
  }

  /// A source that no number names, if there is one.
  const std::string* unused() const {
    for (const auto& [key, citation] : sources_)
      if (!named_.contains(key)) return &key;
    return nullptr;
  }

 private:
  /// Fills in where the value comes from. @returns the value.
  template <class T>
  JsonValue origin(const JsonValue& value, Sourced<T>& sourced) {
    value.expect_keys({"value", "source", "estimated", "note"});
    const auto source = value.get("source"), estimated = value.get("estimated"), note = value.get("note");
    if (bool(source) == bool(estimated)) value.fail("needs either \"source\" or \"estimated\": true");
    if (estimated && !estimated->yes_or_no()) estimated->fail("must be true; a number that is cited has a source");
    if (source) {
      sourced.source = source->text();
      if (!sources_.contains(sourced.source)) source->fail("'" + sourced.source + "' is none of the file's sources");
      named_.insert(sourced.source);
    }
    if (note) sourced.note = note->text();
    return value.require("value");
  }

  const std::map<std::string, std::string>& sources_;
  std::set<std::string> named_;
};

std::string some_text(const JsonValue& value) {
  std::string text = value.text();
  if (text.empty()) value.fail("must not be empty");
  return text;
}

BilingualWords read_words(const JsonValue& file, const char* key, bool is_required) {
  const auto value = file.get(key);
  if (!value) {
    if (is_required) file.require(key);
    return {};
  }
  value->expect_keys({"en", "de"});
  BilingualWords words;
  for (const auto& [language, list] : {std::pair{"en", &words.en}, std::pair{"de", &words.de}}) {
    const JsonValue given = value->require(language);
    for (const JsonValue& word : given.list()) list->push_back(some_text(word));
    if (is_required && list->empty()) given.fail("must not be empty");
  }
  return words;
}

LibraryRelief read_relief(const JsonValue& value, const std::filesystem::path& file, SourcedReader& reader) {
  value.expect_keys({"recipe", "grain", "picture", "process", "size_mm", "depth_mm", "show"});
  LibraryRelief relief;
  const auto recipe = value.get("recipe"), grain = value.get("grain"), picture = value.get("picture");
  if (int(bool(recipe)) + int(bool(grain)) + int(bool(picture)) != 1)
    value.fail("needs one of 'recipe', 'grain', 'picture'");
  if (recipe) relief.recipe = some_text(*recipe);
  if (grain) {
    grain->expect_keys({"kind", "seed"});
    relief.grain = grain_kind(grain->require("kind").one_of(grain_names()));
    if (const auto seed = grain->get("seed")) {
      if (!seed->json().is_number_integer()) seed->fail("must be a whole number");
      relief.seed = static_cast<std::uint64_t>(seed->number(0, 1e9));
    }
  }
  if (picture) {
    const auto found = resolve_reference({file.parent_path(), file.string() + ": at /relief/picture", picture->text()});
    if (!found) picture->fail("'" + picture->text() + "' does not exist");
    relief.picture = *found;
  }
  if (const auto process = value.get("process")) {
    if (!picture) process->fail("is of a picture");
    relief.process = some_text(*process);
  }
  const JsonValue size = value.require("size_mm");
  if (!size.json().is_array() || size.json().size() != 2) size.fail("must be [width, height]");
  for (std::size_t k = 0; k < 2; ++k) relief.size_mm[k] = reader.number(size.at(k), 1e-3, 1e5);
  relief.depth_mm = reader.number(value.require("depth_mm"), 1e-6, 100);
  if (const auto show = value.get("show")) relief.is_shown = show->one_of({"relief", "picture"}) == "picture";
  return relief;
}

LibraryRoughness read_roughness(const JsonValue& value, SourcedReader& reader) {
  value.expect_keys({"hurst", "rms", "wavelength_range"});
  LibraryRoughness roughness;
  roughness.hurst = reader.number(value.require("hurst"), 0.01, 0.99);
  roughness.rms_m = reader.number(value.require("rms"), 0, 5e-3);
  const JsonValue range = value.require("wavelength_range");
  if (!range.json().is_array() || range.json().size() != 2) range.fail("must be [shortest, longest]");
  for (std::size_t k = 0; k < 2; ++k) roughness.wavelength_range_m[k] = reader.number(range.at(k), 1e-7, 1);
  if (!(roughness.wavelength_range_m[0].value < roughness.wavelength_range_m[1].value))
    range.fail("must be [shortest, longest]");
  return roughness;
}

std::map<std::string, std::string> read_sources(const JsonValue& file) {
  std::map<std::string, std::string> sources;
  const auto value = file.get("sources");
  if (!value) return sources;
  value->expect_object();
  for (const auto& [key, unused] : value->json().items()) sources[key] = some_text(*value->get(key));
  return sources;
}

std::string id_of(const std::filesystem::path& folder, const std::filesystem::path& file) {
  return file.lexically_relative(folder).replace_extension().generic_string();
}

}  // namespace

bool is_library_id(std::string_view text) noexcept {
  bool was_word = false;
  for (const char c : text) {
    const bool word = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || (c == '-' && was_word);
    if (!word && !(c == '/' && was_word)) return false;
    was_word = word;
  }
  return was_word;
}

LibraryMaterial read_library_material(const std::filesystem::path& folder, const std::filesystem::path& file) {
  const JsonValue::Json json = read_json(file);
  const JsonValue root(json, file.string(), "");
  root.expect_keys({"$schema", "$comment", "version", "names", "aliases", "categories", "uses", "stiffness", "damping",
                    "staticFriction", "dynamicFriction", "stribeckVelocity", "youngsModulus", "backing", "relief",
                    "roughness", "appearance", "sources"});
  if (const JsonValue version = root.require("version"); version.number(0, 1e9) != 1)
    version.fail("only version 1 is known");
  LibraryMaterial material;
  material.id = id_of(folder, file);
  if (!is_library_id(material.id))
    root.fail("the file's name '" + material.id + "' must be of a-z, 0-9 and '-', as it is the material's id");
  material.file = file;
  const JsonValue names = root.require("names");
  names.expect_keys({"en", "de"});
  material.name_en = some_text(names.require("en"));
  material.name_de = some_text(names.require("de"));
  material.aliases = read_words(root, "aliases", false);
  material.categories = read_words(root, "categories", true);
  material.uses = read_words(root, "uses", false);
  material.sources = read_sources(root);

  SourcedReader reader(material.sources);
  material.stiffness = reader.number(root.require("stiffness"), 1e-3, 1e6);
  material.damping = reader.number(root.require("damping"), 0, 1e4);
  material.static_friction = reader.number(root.require("staticFriction"), 0, 10);
  material.dynamic_friction = reader.number(root.require("dynamicFriction"), 0, 10);
  if (material.dynamic_friction.value > material.static_friction.value)
    root.fail("dynamicFriction must not exceed staticFriction");
  material.stribeck_velocity = reader.number(root.require("stribeckVelocity"), 1e-6, 10);
  if (const auto v = root.get("youngsModulus")) material.youngs_modulus = reader.number(*v, 1, 2e12);
  if (const auto v = root.get("backing")) {
    v->expect_keys({"stiffness", "depth_mm"});
    material.backing = {reader.number(v->require("stiffness"), 1e-3, 1e6),
                        reader.number(v->require("depth_mm"), 0, 100)};
  }
  if (const auto v = root.get("relief")) material.relief = read_relief(*v, file, reader);
  if (const auto v = root.get("roughness")) material.roughness = read_roughness(*v, reader);
  const JsonValue appearance = root.require("appearance");
  appearance.expect_keys({"color", "roughness", "metallic"});
  material.appearance = {reader.colour(appearance.require("color")),
                         reader.number(appearance.require("roughness"), 0, 1),
                         reader.number(appearance.require("metallic"), 0, 1)};
  if (const std::string* unused = reader.unused())
    root.require("sources").fail("no number names the source '" + *unused + "'");
  return material;
}

std::vector<LibraryNumber> numbers_of(const LibraryMaterial& material) {
  std::vector<LibraryNumber> numbers;
  const auto add = [&](std::string key, const SourcedNumber& number) {
    numbers.push_back({std::move(key), plain_number(number.value), number.source, number.note});
  };
  add("stiffness", material.stiffness);
  add("damping", material.damping);
  add("staticFriction", material.static_friction);
  add("dynamicFriction", material.dynamic_friction);
  add("stribeckVelocity", material.stribeck_velocity);
  if (material.youngs_modulus) add("youngsModulus", *material.youngs_modulus);
  if (const auto& backing = material.backing) {
    add("backing/stiffness", backing->stiffness);
    add("backing/depth_mm", backing->depth_mm);
  }
  if (const auto& relief = material.relief) {
    add("relief/size_mm/0", relief->size_mm[0]);
    add("relief/size_mm/1", relief->size_mm[1]);
    add("relief/depth_mm", relief->depth_mm);
  }
  if (const auto& roughness = material.roughness) {
    add("roughness/hurst", roughness->hurst);
    add("roughness/rms", roughness->rms_m);
    add("roughness/wavelength_range/0", roughness->wavelength_range_m[0]);
    add("roughness/wavelength_range/1", roughness->wavelength_range_m[1]);
  }
  const LibraryAppearance& look = material.appearance;
  numbers.push_back({"appearance/color", look.color.value, look.color.source, look.color.note});
  add("appearance/roughness", look.roughness);
  add("appearance/metallic", look.metallic);
  return numbers;
}

MaterialRule rule_of(const LibraryMaterial& material, const std::string& name) {
  MaterialRule rule;
  rule.name = name;
  rule.stiffness = material.stiffness.value;
  rule.damping = material.damping.value;
  rule.static_friction = material.static_friction.value;
  rule.dynamic_friction = material.dynamic_friction.value;
  rule.stribeck_velocity = material.stribeck_velocity.value;
  if (const auto& backing = material.backing)
    rule.backing = BackingTag{backing->stiffness.value, k_metres_per_mm * backing->depth_mm.value};
  if (const auto& roughness = material.roughness)
    rule.fine_roughness = RoughnessModel{.hurst = roughness->hurst.value,
                                         .rms_mm = k_mm_per_metre * roughness->rms_m.value,
                                         .shortest_mm = k_mm_per_metre * roughness->wavelength_range_m[0].value,
                                         .longest_mm = k_mm_per_metre * roughness->wavelength_range_m[1].value};
  rule.color = material.appearance.color.value;
  rule.roughness = material.appearance.roughness.value;
  rule.metallic = material.appearance.metallic.value;
  if (const auto& relief = material.relief) {
    rule.recipe = relief->grain              ? std::string(k_grain_prefix) + std::string(to_string(*relief->grain))
                  : !relief->picture.empty() ? relief->picture.string()
                                             : relief->recipe;
    rule.texture = relief->picture.empty() ? material.file.parent_path() / rule.recipe : relief->picture;
    for (std::size_t k = 0; k < 2; ++k) rule.size_mm[k] = relief->size_mm[k].value;
    rule.height.depth_mm = relief->depth_mm.value;
    rule.height.relief.height.seed = relief->seed;
    rule.show = relief->is_shown ? "picture" : "relief";
  }
  return rule;
}

double rendered_stiffness(double youngs_modulus_pa) {
  constexpr double k_wall = 2500, k_finger_radius_m = 8e-3, k_force_n = 1, k_poisson = 0.3;
  const double modulus = youngs_modulus_pa / (1 - k_poisson * k_poisson);
  const double hertz = std::cbrt(6 * modulus * modulus * k_finger_radius_m * k_force_n);
  return 1 / (1 / k_wall + 1 / hertz);
}

}  // namespace papilla
