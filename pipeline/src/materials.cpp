// SPDX-License-Identifier: MIT
#include "papilla/pipeline/materials.hpp"

#include <nlohmann/json.hpp>
#include <vector>

#include "json_value.hpp"
#include "papilla/core/near_name.hpp"

namespace papilla {
namespace {

HeightRule read_height(const JsonValue& value) {
  value.expect_keys({"method", "depth_mm", "scale", "max_slope"});
  HeightRule rule;
  if (const auto v = value.get("method"))
    rule.method = v->one_of({"auto", "wiener", "variational", "pentland", "tsai-shah", "intensity"});
  if (const auto v = value.get("depth_mm")) rule.depth_mm = v->number(1e-6, 100);
  if (const auto v = value.get("scale")) rule.scale = v->number(0, 100);
  if (const auto v = value.get("max_slope")) rule.max_slope = v->number(0.01, 1000);
  return rule;
}

FrictionTag read_friction_model(const JsonValue& value) {
  value.expect_keys({"name", "stiffness"});
  FrictionTag tag;
  if (const auto v = value.get("name")) tag.name = v->one_of({"coulomb", "bristle"});
  if (const auto v = value.get("stiffness")) tag.stiffness = v->number(0, 1e7);
  return tag;
}

MaterialRule read_material(const JsonValue& value, const std::string& name, const std::filesystem::path& folder) {
  value.expect_keys({"texture", "time", "size_mm", "stiffness", "damping", "staticFriction", "dynamicFriction",
                     "stribeckVelocity", "frictionModel", "forceShading", "height", "unwrap", "show", "color",
                     "roughness", "metallic", "$comment"});
  MaterialRule rule;
  rule.name = name;
  if (const auto v = value.get("texture")) {
    const std::string texture = v->text();
    if (texture.empty()) v->fail("must not be empty");
    rule.texture = folder / texture;
    rule.recipe = texture;
  }
  if (const auto v = value.get("time")) rule.time = v->number(0, 1);
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
  if (const auto v = value.get("forceShading")) rule.force_shading = v->yes_or_no();
  number("roughness", rule.roughness, 0, 1);
  number("metallic", rule.metallic, 0, 1);
  if (rule.static_friction && rule.dynamic_friction && *rule.dynamic_friction > *rule.static_friction)
    value.fail("dynamicFriction must not exceed staticFriction");
  if (const auto v = value.get("height")) rule.height = read_height(*v);
  if (const auto v = value.get("unwrap"))
    rule.unwrap = v->one_of({"auto", "keep", "new", "best", "triplanar", "lscm", "levy", "maillot", "natural"});
  if (const auto v = value.get("show")) rule.show = v->one_of({"auto", "picture", "relief"});
  if (const auto v = value.get("color")) rule.color = v->hex_colour();
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

Materials read_materials(const std::filesystem::path& path) {
  const JsonValue::Json json = read_json(path);
  const JsonValue root(json, path.string(), "");
  root.expect_keys({"$schema", "version", "materials", "assign", "$comment"});
  if (const auto v = root.get("version"))
    if (v->number(0, 1e9) != 1) v->fail("only version 1 is known");

  Materials file;
  file.source = path.string();
  const JsonValue materials = root.require("materials");
  materials.expect_object();
  for (const auto& [name, unused] : materials.json().items())
    file.materials.emplace(name, read_material(*materials.get(name), name, path.parent_path()));
  if (const auto assign = root.get("assign"))
    for (const JsonValue& rule : assign->list()) file.assign.push_back(read_assign(rule, file));
  return file;
}

}  // namespace papilla
