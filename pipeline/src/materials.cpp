// SPDX-License-Identifier: MIT
#include "papilla/pipeline/materials.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/read_file.hpp"

namespace papilla {
namespace {

using Json = nlohmann::json;

std::string escaped(std::string_view key) {
  std::string out;
  for (const char c : key) {
    if (c == '~')
      out += "~0";
    else if (c == '/')
      out += "~1";
    else
      out += c;
  }
  return out;
}

/// A JSON value that knows its file and pointer, so that every complaint names the place.
class Value {
 public:
  Value(const Json& json, std::string file, std::string pointer)
      : json_(json), file_(std::move(file)), pointer_(std::move(pointer)) {}

  [[noreturn]] void fail(const std::string& reason) const {
    // Keys may hold anything, a message is one line.
    throw InvalidInput(shown(file_ + ": at " + (pointer_.empty() ? "the top level" : pointer_) + ": " + reason));
  }
  const Json& json() const { return json_; }

  Value require(const char* key) const {
    const auto member = get(key);
    if (!member) fail(std::string("'") + key + "' is missing");
    return *member;
  }
  std::optional<Value> get(const std::string& key) const {
    expect_object();
    const auto it = json_.find(key);
    if (it == json_.end()) return std::nullopt;
    return Value(*it, file_, pointer_ + "/" + escaped(key));
  }
  Value at(std::size_t index) const { return {json_[index], file_, pointer_ + "/" + std::to_string(index)}; }

  void expect_object() const {
    if (!json_.is_object()) fail("must be an object");
  }
  void expect_keys(std::initializer_list<std::string_view> known) const {
    expect_object();
    for (const auto& [key, unused] : json_.items()) {
      if (std::find(known.begin(), known.end(), key) != known.end()) continue;
      std::string list;
      for (const auto name : known) list += (list.empty() ? "" : ", ") + std::string(name);
      fail("unknown key '" + key + "'; known are " + list);
    }
  }
  std::string text() const {
    if (!json_.is_string()) fail("must be a string");
    return json_.get<std::string>();
  }
  bool yes_or_no() const {
    if (!json_.is_boolean()) fail("must be true or false");
    return json_.get<bool>();
  }
  std::string one_of(std::initializer_list<std::string_view> choices) const {
    const std::string value = text();
    if (std::find(choices.begin(), choices.end(), value) != choices.end()) return value;
    std::string list;
    for (const auto choice : choices) list += (list.empty() ? "" : ", ") + std::string(choice);
    fail("'" + value + "' must be one of " + list);
  }
  double number(double low, double high) const {
    if (!json_.is_number()) fail("must be a number");
    const double value = json_.get<double>();
    if (!(value >= low && value <= high))
      fail(json_.dump() + " is outside [" + Json(low).dump() + ", " + Json(high).dump() + "]");
    return value;
  }
  std::string hex_colour() const {
    std::string value = text();
    const bool good =
        value.size() == 7 && value[0] == '#' &&
        std::all_of(value.begin() + 1, value.end(), [](unsigned char c) { return std::isxdigit(c) != 0; });
    if (!good) fail("'" + value + "' must be a colour such as #20a0FF");
    std::transform(value.begin(), value.end(), value.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return value;
  }

 private:
  const Json& json_;
  std::string file_, pointer_;
};

HeightRule read_height(const Value& value) {
  value.expect_keys({"method", "depth_mm", "scale", "max_slope"});
  HeightRule rule;
  if (const auto v = value.get("method"))
    rule.method = v->one_of({"auto", "variational", "pentland", "tsai-shah", "intensity"});
  if (const auto v = value.get("depth_mm")) rule.depth_mm = v->number(1e-6, 100);
  if (const auto v = value.get("scale")) rule.scale = v->number(0, 100);
  if (const auto v = value.get("max_slope")) rule.max_slope = v->number(0.01, 1000);
  return rule;
}

FrictionTag read_friction_model(const Value& value) {
  value.expect_keys({"name", "stiffness"});
  FrictionTag tag;
  if (const auto v = value.get("name")) tag.name = v->one_of({"coulomb", "bristle"});
  if (const auto v = value.get("stiffness")) tag.stiffness = v->number(0, 1e7);
  return tag;
}

MaterialRule read_material(const Value& value, const std::string& name, const std::filesystem::path& folder) {
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

AssignRule read_assign(const Value& value, const Materials& file) {
  value.expect_keys({"part", "cad_colour", "gltf_material", "material", "$comment"});
  AssignRule rule;
  if (const auto v = value.get("part")) rule.part = v->text();
  if (const auto v = value.get("cad_colour")) rule.cad_colour = v->hex_colour();
  if (const auto v = value.get("gltf_material")) rule.gltf_material = v->text();
  if (!rule.part && !rule.cad_colour && !rule.gltf_material)
    value.fail("needs one of 'part', 'cad_colour', 'gltf_material'");
  const Value material = value.require("material");
  if (material.json().is_null()) return rule;
  rule.material = material.text();
  if (!file.materials.contains(rule.material)) material.fail("there is no material '" + rule.material + "'");
  return rule;
}

bool matches(const std::string& pattern, std::string_view name) {
  return ::fnmatch(pattern.c_str(), std::string(name).c_str(), 0) == 0;
}

}  // namespace

Materials read_materials(const std::filesystem::path& path) {
  Json json;
  try {
    json = Json::parse(read_file(path));
  } catch (const Json::parse_error& parse_error) {
    throw InvalidInput(path.string() + ": byte " + std::to_string(parse_error.byte) + ": is no valid JSON");
  } catch (const Json::out_of_range&) {
    throw InvalidInput(path.string() + ": holds a number beyond the range of 64-bit floats");
  }
  const Value root(json, path.string(), "");
  root.expect_keys({"$schema", "version", "materials", "assign", "$comment"});
  if (const auto v = root.get("version"))
    if (v->number(0, 1e9) != 1) v->fail("only version 1 is known");

  Materials file;
  const Value materials = root.require("materials");
  materials.expect_object();
  for (const auto& [name, unused] : materials.json().items())
    file.materials.emplace(name, read_material(*materials.get(name), name, path.parent_path()));
  if (const auto assign = root.get("assign")) {
    if (!assign->json().is_array()) assign->fail("must be an array");
    for (std::size_t i = 0; i < assign->json().size(); ++i) file.assign.push_back(read_assign(assign->at(i), file));
  }
  return file;
}

const AssignRule* match_rule(const Materials& file, std::string_view part, std::string_view colour,
                             std::string_view material) {
  for (const AssignRule& rule : file.assign) {
    if (rule.part && !matches(*rule.part, part)) continue;
    if (rule.cad_colour && *rule.cad_colour != colour) continue;
    if (rule.gltf_material && !matches(*rule.gltf_material, material)) continue;
    return &rule;
  }
  return nullptr;
}

}  // namespace papilla
