// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <utility>

namespace papilla::test {

/// Whether a value fits a JSON Schema, of which this knows $ref into the same file, type, const, enum, properties,
/// required, additionalProperties, dependentRequired, items, minItems, maxItems, minProperties, minimum, maximum,
/// minLength, pattern, anyOf and oneOf.
class JsonSchema {
 public:
  using Json = nlohmann::ordered_json;

  explicit JsonSchema(Json root) : root_(std::move(root)) {}

  bool accepts(const Json& value) const { return fits(value, root_); }

 private:
  static bool is_type(const Json& value, const std::string& type) {
    if (type == "object") return value.is_object();
    if (type == "array") return value.is_array();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "null") return value.is_null();
    if (type == "integer") return value.is_number_integer();
    return value.is_number();
  }

  bool fits_object(const Json& value, const Json& schema) const {
    const Json none = Json::object();
    const Json& properties = schema.contains("properties") ? schema["properties"] : none;
    for (const Json& key : schema.value("required", Json::array()))
      if (!value.contains(key.get<std::string>())) return false;
    if (value.size() < schema.value("minProperties", std::size_t{0})) return false;
    const Json& dependent = schema.contains("dependentRequired") ? schema["dependentRequired"] : none;
    for (const auto& [key, others] : dependent.items())
      for (const Json& other : others)
        if (value.contains(key) && !value.contains(other.get<std::string>())) return false;
    for (const auto& [key, member] : value.items()) {
      if (properties.contains(key)) {
        if (!fits(member, properties[key])) return false;
      } else if (schema.contains("additionalProperties")) {
        const Json& more = schema["additionalProperties"];
        if (more.is_boolean() ? !more.get<bool>() : !fits(member, more)) return false;
      }
    }
    return true;
  }

  bool fits(const Json& value, const Json& schema) const {
    if (schema.contains("$ref"))
      if (!fits(value, root_.at(Json::json_pointer(schema["$ref"].get<std::string>().substr(1))))) return false;
    if (schema.contains("type")) {
      const Json& type = schema["type"];
      bool any = false;
      for (const Json& one : type.is_array() ? type : Json::array({type})) any |= is_type(value, one);
      if (!any) return false;
    }
    if (schema.contains("const") && value != schema["const"]) return false;
    if (schema.contains("enum") &&
        std::find(schema["enum"].begin(), schema["enum"].end(), value) == schema["enum"].end())
      return false;
    for (const char* keyword : {"anyOf", "oneOf"}) {
      if (!schema.contains(keyword)) continue;
      int count = 0;
      for (const Json& one : schema[keyword]) count += fits(value, one) ? 1 : 0;
      if (count == 0 || (count > 1 && std::string(keyword) == "oneOf")) return false;
    }
    if (value.is_number()) {
      if (schema.contains("minimum") && value.get<double>() < schema["minimum"].get<double>()) return false;
      if (schema.contains("maximum") && value.get<double>() > schema["maximum"].get<double>()) return false;
    }
    if (value.is_string()) {
      const std::string text = value.get<std::string>();
      if (text.size() < schema.value("minLength", std::size_t{0})) return false;
      if (schema.contains("pattern") && !std::regex_search(text, std::regex(schema["pattern"].get<std::string>())))
        return false;
    }
    if (value.is_array()) {
      if (value.size() < schema.value("minItems", std::size_t{0})) return false;
      if (schema.contains("maxItems") && value.size() > schema["maxItems"].get<std::size_t>()) return false;
      if (schema.contains("items"))
        for (const Json& item : value)
          if (!fits(item, schema["items"])) return false;
    }
    return !value.is_object() || fits_object(value, schema);
  }

  Json root_;
};

}  // namespace papilla::test
