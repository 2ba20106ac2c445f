// SPDX-License-Identifier: MIT
#include "papilla/pipeline/materials.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "json_value.hpp"
#include "lights_value.hpp"
#include "object_textures/rules.hpp"
#include "papilla/core/near_name.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/units.hpp"
#include "papilla/haptic/stimulus.hpp"
#include "papilla/pipeline/library_material.hpp"
#include "papilla/pipeline/material_library.hpp"
#include "papilla/pipeline/studio/parse_materials.hpp"
#include "unwrap_value.hpp"

namespace papilla {
namespace {

bool is_word(const JsonValue& value, const char* word) { return value.json().is_string() && value.json() == word; }

/// "auto", or three numbers.
std::optional<Vec3> read_light(const JsonValue& value) {
  if (is_word(value, "auto")) return std::nullopt;
  if (!value.json().is_array() || value.json().size() != 3) value.fail("must be \"auto\" or [x, y, z]");
  const Vec3 light{value.at(0).number(-1e6, 1e6), value.at(1).number(-1e6, 1e6), value.at(2).number(-1e6, 1e6)};
  if (!(light.z > 0)) value.fail("must have z > 0, towards the viewer");
  return light;
}

/// "none", "auto" with the device's rate and the hand's speed, or millimetres.
double read_cut(const JsonValue& height, const JsonValue& value) {
  if (is_word(value, "none")) return 0;
  if (!is_word(value, "auto")) return value.number(1e-3, 1e3);
  const auto rate = height.get("rate"), speed = height.get("speed");
  return shortest_playable_wavelength_mm(speed ? speed->number(1e-3, 1e4) : k_hand_speed_mm_per_s,
                                         rate ? rate->number(1, 1e6) : k_device_rate_hz);
}

/// The photographs of one place, what lit them, and what is known of their scale. Lights and references are a file
/// beside MATERIALS.json, or stand in it.
void read_photographs(const JsonValue& value, const std::filesystem::path& source, HeightRule& rule) {
  const auto images = value.get("images"), lights = value.get("lights"), reference = value.get("reference");
  if (!images) {
    for (const auto& key : {lights, reference})
      if (key) key->fail("needs 'images', three or more photographs");
    return;
  }
  for (const char* key : {"method", "light", "periodic", "roughness", "cut", "rate", "speed", "tile", "source", "seed"})
    if (const auto v = value.get(key)) v->fail("is for one picture, not for 'images'");
  const std::filesystem::path folder = source.parent_path();
  for (const JsonValue& image : images->list()) {
    if (image.text().empty()) image.fail("must not be empty");
    rule.images.push_back(folder / image.text());
  }
  constexpr std::size_t k_least = 3;
  if (rule.images.size() < k_least) images->fail("must be three photographs or more");
  const auto is_file = [](const JsonValue& v) { return v.json().is_string() && v.json() != "unknown"; };
  const auto read = [](const JsonValue& key, const auto& work) {
    try {
      return work();
    } catch (const IoError& error) {
      key.fail(error.what());
    } catch (const InvalidInput& error) {
      key.fail(error.what());
    }
  };
  if (lights) {
    rule.lights = is_file(*lights)
                      ? read(*lights, [&] { return read_lights(folder / lights->text(), rule.images.size()); })
                      : lights_of_value(*lights, rule.images.size());
    if (rule.lights.source.empty()) rule.lights.source = "lights";
  }
  if (reference)
    rule.references = is_file(*reference)
                          ? read(*reference, [&] { return read_references(folder / reference->text()); })
                          : references_of_value(*reference, source);
}

/// @param rule  gets what the file says.
void read_height(const JsonValue& value, const std::filesystem::path& source, HeightRule& rule) {
  value.expect_keys({"method",      "depth_mm",  "depth",    "scale",  "max_slope", "pitch",    "light",
                     "periodic",    "roughness", "transfer", "cut",    "rate",      "speed",    "tile",
                     "alternative", "source",    "seed",     "images", "lights",    "reference"});
  read_photographs(value, source, rule);
  HeightOptions& height = rule.relief.height;
  if (const auto v = value.get("method"))
    height.method = height_method(v->one_of({"auto", "wiener", "variational", "pentland", "tsai-shah", "intensity"}));
  const auto depth_mm = value.get("depth_mm"), depth = value.get("depth");
  if (depth_mm && depth) depth->fail("is the same as depth_mm: only one of them");
  if (depth_mm || depth) rule.depth_mm = (depth_mm ? depth_mm : depth)->number(1e-6, 100);
  if (const auto v = value.get("pitch")) rule.pitch_mm = v->number(1e-6, 1e3);
  if (const auto v = value.get("light")) height.light = read_light(*v);
  if (const auto v = value.get("periodic"))
    if (!is_word(*v, "auto")) height.periodic = v->yes_or_no();
  if (const auto v = value.get("roughness"))
    if (const std::string name = v->one_of({"auto", "whole", "none", "residual", "synthesized"}); name != "auto")
      rule.relief.roughness = height_roughness(name);
  if (const auto v = value.get("transfer")) height.transfer = transfer(v->one_of({"auto", "srgb", "linear"}));
  if (const auto v = value.get("cut")) height.shortest_wavelength_mm = read_cut(value, *v);
  if (const auto v = value.get("tile"))
    if (!is_word(*v, "auto")) rule.relief.tile = v->yes_or_no();
  if (const auto v = value.get("alternative")) rule.opposite = v->yes_or_no();
  if (const auto v = value.get("source"))
    rule.relief.source = relief_source(v->one_of({"auto", "picture", "synthesis"}));
  if (const auto v = value.get("seed")) height.seed = static_cast<std::uint64_t>(v->number(0, 1e9));
  if (const auto v = value.get("scale")) rule.scale = v->number(0, 100);
  if (const auto v = value.get("max_slope")) rule.max_slope = v->number(0.01, 1000);
}

FrictionTag read_friction_model(const JsonValue& value) {
  value.expect_keys({"name", "stiffness"});
  FrictionTag tag;
  if (const auto v = value.get("name")) tag.name = v->one_of({"coulomb", "bristle"});
  if (const auto v = value.get("stiffness")) tag.stiffness = v->number(0, 1e7);
  return tag;
}

ForceModelTag read_force_model(const JsonValue& value) {
  value.expect_keys({"name", "amplitude", "sign", "form", "level"});
  ForceModelTag tag;
  if (const auto v = value.get("name"))
    tag.name = name_of(*force_model(v->one_of({"heightfield", "orthogonal", "lateral", "lateral-isotropic", "graph",
                                               "graph-orthogonal", "graph-lateral", "textured-normal"})));
  if (const auto v = value.get("amplitude")) tag.amplitude = v->number(0, 100);
  if (const auto v = value.get("sign")) tag.literal = v->one_of({"downhill", "physical", "literal"}) == "literal";
  if (const auto v = value.get("form")) {
    const std::string form = v->one_of({"gradient", "displacement", "path", "place"});
    if (!stimulus_form(*force_model(tag.name), form)) v->fail("'" + form + "' is no form of '" + tag.name + "'");
    tag.form = form;
  }
  if (const auto v = value.get("level")) {
    const double level = v->number(1, GreyGraph::k_finest_level);
    if (level != std::floor(level)) v->fail("must be a whole number");
    tag.level = static_cast<int>(level);
  }
  return tag;
}

BackingTag read_backing(const JsonValue& value) {
  value.expect_keys({"stiffness", "depth_mm"});
  return {value.require("stiffness").number(1e-3, 1e6), k_metres_per_mm * value.require("depth_mm").number(0, 100)};
}

RoughnessModel read_fine_roughness(const JsonValue& value) {
  value.expect_keys({"hurst", "rms", "wavelength_range"});
  const JsonValue range = value.require("wavelength_range");
  if (range.list().size() != 2) range.fail("must be [shortest, longest]");
  RoughnessModel model;
  model.hurst = value.require("hurst").number(0.01, 0.99);
  model.rms_mm = k_mm_per_metre * value.require("rms").number(0, 0.005);
  model.shortest_mm = k_mm_per_metre * range.at(0).number(1e-9, 1);
  model.longest_mm = k_mm_per_metre * range.at(1).number(1e-9, 1);
  if (!(model.shortest_mm < model.longest_mm)) range.fail("must go from short to long");
  return model;
}

void check_grain(const JsonValue& value, const std::string& name) {
  const std::vector<std::string_view> known = grain_names();
  if (std::find(known.begin(), known.end(), name) == known.end())
    value.fail("there is no grain '" + name + "'" + did_you_mean(name, known));
}

void read_range(const JsonValue& value, double (&range)[2]) {
  constexpr double k_most = 100;
  if (value.list().size() != 2) value.fail("must be [black, white]");
  for (std::size_t k = 0; k < 2; ++k) range[k] = value.at(k).number(0, k_most);
}

/// "FILE", a recipe, or {"picture": that, "range": [black, white]}.
MapRule read_map(const JsonValue& value, const std::filesystem::path& source, MapRule rule) {
  const bool is_object = value.json().is_object();
  if (is_object) {
    value.expect_keys({"picture", "range"});
    if (const auto range = value.get("range")) read_range(*range, rule.range);
  }
  const JsonValue picture = is_object ? value.require("picture") : value;
  rule.recipe = picture.text();
  if (rule.recipe.empty()) picture.fail("must not be empty");
  if (rule.recipe.starts_with(k_grain_prefix)) check_grain(picture, rule.recipe.substr(k_grain_prefix.size()));
  rule.picture = source.parent_path() / rule.recipe;
  return rule;
}

void read_maps(const JsonValue& value, const std::filesystem::path& source, MaterialRule& rule) {
  value.expect_keys({"stiffness", "friction", "damping", "range"});
  if (rule.texture.empty())
    value.fail("needs a 'texture', on whose repeats the maps lie; \"texture\": \"col\" with a size_mm is a smooth one");
  MapRule common;
  if (const auto range = value.get("range")) read_range(*range, common.range);
  for (const Quantity quantity : {Quantity::stiffness, Quantity::dynamic_friction, Quantity::damping})
    if (const auto v = value.get(std::string(map_key(quantity))))
      rule.maps.insert_or_assign(quantity, read_map(*v, source, common));
  if (rule.maps.empty()) value.fail("needs one of 'stiffness', 'friction', 'damping'");
}

/// The rule of the library's material that "library:ID" names.
MaterialRule library_rule(const JsonValue& value, const std::string& name, const std::filesystem::path& library) {
  const std::string text = value.text();
  const std::string id = text.substr(std::min(text.size(), k_library_prefix.size()));
  if (!text.starts_with(k_library_prefix) || !is_library_id(id))
    value.fail("must be \"library:\" and the id of a material of the library");
  try {
    const MaterialLibrary all(library.empty() ? find_material_library() : library);
    MaterialRule rule = rule_of(all.material(id), name);
    rule.library = id;
    return rule;
  } catch (const UnknownMaterial& unknown) {
    value.fail(unknown.what());
  }
}

MaterialRule read_material(const JsonValue& value, const std::string& name, const std::filesystem::path& source,
                           const std::filesystem::path& library) {
  value.expect_keys({"material",        "texture",          "time",          "size_mm",
                     "phase_mm",        "stiffness",        "damping",       "staticFriction",
                     "dynamicFriction", "stribeckVelocity", "frictionModel", "forceModel",
                     "forceShading",    "height",           "maps",          "backing",
                     "fineRoughness",   "unwrap",           "show",          "color",
                     "roughness",       "metallic",         "environment",   "$comment"});
  MaterialRule rule;
  if (const auto v = value.get("material")) rule = library_rule(*v, name, library);
  rule.name = name;
  if (const auto v = value.get("texture")) {
    const std::string texture = v->text();
    if (texture.empty()) v->fail("must not be empty");
    if (texture.starts_with(k_grain_prefix)) check_grain(*v, texture.substr(k_grain_prefix.size()));
    rule.texture = source.parent_path() / texture;
    rule.recipe = texture;
  }
  if (const auto v = value.get("time")) rule.time = v->number(0, 1);
  if (const auto v = value.get("phase_mm")) {
    if (!v->json().is_array() || v->json().size() != 2) v->fail("must be [u, v]");
    rule.phase_mm = {v->at(0).number(-1e5, 1e5), v->at(1).number(-1e5, 1e5)};
  }
  if (const auto v = value.get("size_mm")) {
    if (!v->json().is_array() || v->json().size() != 2) v->fail("must be [width, height]");
    for (std::size_t k = 0; k < 2; ++k) rule.size_mm[k] = v->at(k).number(1e-3, 1e5);
  }
  const auto number = [&](const char* key, std::optional<double>& target, double low, double high) {
    if (const auto v = value.get(key)) target = v->number(low, high);
  };
  number("stiffness", rule.stiffness, 1e-3, 1e6);
  number("damping", rule.damping, 0, 1e4);
  number("staticFriction", rule.static_friction, 0, 10);
  number("dynamicFriction", rule.dynamic_friction, 0, 10);
  number("stribeckVelocity", rule.stribeck_velocity, 1e-6, 10);
  if (const auto v = value.get("frictionModel")) rule.friction_model = read_friction_model(*v);
  if (const auto v = value.get("forceModel")) rule.force_model = read_force_model(*v);
  if (const auto v = value.get("forceShading")) rule.force_shading = v->yes_or_no();
  number("roughness", rule.roughness, 0, 1);
  number("metallic", rule.metallic, 0, 1);
  if (rule.static_friction && rule.dynamic_friction && *rule.dynamic_friction > *rule.static_friction)
    value.fail(rule.library.empty() ? "dynamicFriction must not exceed staticFriction"
                                    : "dynamicFriction must not exceed staticFriction; one of them is the library's");
  if (const auto v = value.get("height")) read_height(*v, source, rule.height);
  if (!rule.height.images.empty() && (rule.texture.empty() || !value.get("texture"))) {
    rule.texture = rule.height.images.front();
    rule.recipe.clear();
  }
  if (const auto v = value.get("maps")) read_maps(*v, source, rule);
  if (const auto v = value.get("backing"))
    rule.backing = v->json().is_null() ? std::nullopt : std::optional(read_backing(*v));
  if (const auto v = value.get("fineRoughness"))
    rule.fine_roughness = v->json().is_null() ? std::nullopt : std::optional(read_fine_roughness(*v));
  if (const auto v = value.get("unwrap")) read_unwrap(*v, rule);
  if (const auto v = value.get("show")) rule.show = v->one_of({"auto", "picture", "relief"});
  if (const auto v = value.get("color")) rule.color = v->hex_colour();
  if (const auto v = value.get("environment")) {
    if (v->text().empty()) v->fail("must not be empty");
    rule.environment = source.parent_path() / v->text();
  }
  return rule;
}

AssignRule read_assign(const JsonValue& value, const Materials& file) {
  AssignRule rule{read_selector(value, {"not", "material", "$comment"}), {}};
  if (rule.is_empty()) {
    std::string keys;
    for (const SelectorKey& key : selector_keys()) keys += "'" + std::string(key.name) + "', ";
    value.fail("needs one of " + keys + "'not'");
  }
  const JsonValue material = value.require("material");
  if (material.json().is_null()) return rule;
  rule.material = material.text();
  if (file.materials.contains(rule.material)) return rule;
  std::vector<std::string_view> known;
  for (const auto& [name, unused] : file.materials) known.push_back(name);
  material.fail("there is no material '" + rule.material + "'" + did_you_mean(rule.material, known));
}

}  // namespace

std::string_view map_key(Quantity quantity) noexcept {
  switch (quantity) {
    case Quantity::stiffness:
    case Quantity::damping: return name_of(quantity);
    case Quantity::static_friction:
    case Quantity::dynamic_friction: break;
  }
  return "friction";
}

Materials read_materials(const std::filesystem::path& path, const std::filesystem::path& library) {
  return parse_materials(read_file(path), path, library);
}

Materials parse_materials(const std::string& text, const std::filesystem::path& path,
                          const std::filesystem::path& library) {
  const JsonValue::Json json = parse_json(text, path.string());
  const JsonValue root(json, path.string(), "");
  root.expect_keys({"$schema", "version", "materials", "assign", "decals", "replace", "$comment"});
  if (const auto v = root.get("version"))
    if (v->number(0, 1e9) != 1) v->fail("only version 1 is known");

  Materials file;
  file.source = path.string();
  const JsonValue materials = root.require("materials");
  materials.expect_object();
  for (const auto& [name, unused] : materials.json().items())
    file.materials.emplace(name, read_material(*materials.get(name), name, path, library));
  if (const auto assign = root.get("assign"))
    for (const JsonValue& rule : assign->list()) file.assign.push_back(read_assign(rule, file));
  if (const auto decals = root.get("decals"))
    for (const JsonValue& rule : decals->list()) file.decals.push_back(read_decal(rule, path));
  if (const auto replace = root.get("replace"))
    for (const JsonValue& rule : replace->list()) file.replace.push_back(read_carrier(rule, path));
  return file;
}

}  // namespace papilla
