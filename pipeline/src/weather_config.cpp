// SPDX-License-Identifier: MIT
#include "papilla/pipeline/weather_scene.hpp"

#include <fmt/core.h>
#include <fnmatch.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/read_file.hpp"

namespace papilla {
namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& key, const std::string& reason) {
  // Keys may hold anything, a message is one line.
  throw InvalidInput(path.string() + ": at /" + shown(key) + ": " + reason);
}

}  // namespace

WeatherConfig read_weather_config(const std::filesystem::path& path) {
  const Json json = Json::parse(read_file(path), nullptr, false);
  if (json.is_discarded() || !json.is_object()) throw InvalidInput(path.string() + ": is no JSON object");
  WeatherConfig config;
  config.folder = path.parent_path();
  config.source = path.string();
  const auto number = [&](const Json& value, const std::string& key, double low, double high) {
    if (!value.is_number() || !(value.get<double>() >= low && value.get<double>() <= high))
      refuse(path, key, "must be a number from " + std::to_string(low) + " to " + std::to_string(high));
    return value.get<double>();
  };
  const auto strings = [&](const Json& value, const std::string& key) {
    if (!value.is_array() || !std::all_of(value.begin(), value.end(), [](const Json& s) { return s.is_string(); }))
      refuse(path, key, "must be an array of strings");
    return value.get<std::vector<std::string>>();
  };
  for (const auto& [key, value] : json.items()) {
    if (key == "size")
      config.size = static_cast<int>(number(value, key, 16, 8192));
    else if (key == "atlas")
      config.atlas = static_cast<int>(number(value, key, 64, 8192));
    else if (key == "sky_rays")
      config.sky_rays = static_cast<int>(number(value, key, 1, 4096));
    else if (key == "depth_mm")
      config.depth_mm = number(value, key, 1e-6, 100);
    else if (key == "time" && value.is_array() && !value.empty()) {
      config.times.clear();
      for (const Json& t : value) config.times.push_back(number(t, key, 0, 1));
    } else if (key == "time")
      config.times = {number(value, key, 0, 1)};
    else if (key == "libraries")
      config.libraries = strings(value, key);
    else if (key == "layers" && value.is_array()) {
      for (const Json& entry : value) {
        const std::string place = key + "/" + std::to_string(config.layers.size());
        if (!entry.is_object() || !entry.contains("recipe") || !entry["recipe"].is_string())
          refuse(path, place, "must be an object with the string 'recipe'");
        WeatherLayer layer{entry["recipe"].get<std::string>(), {"*"}};
        for (const auto& [name, unused] : entry.items())
          if (name != "recipe" && name != "materials")
            refuse(path, place + "/" + name, "unknown key; known are recipe, materials");
        if (entry.contains("materials")) layer.materials = strings(entry["materials"], place + "/materials");
        config.layers.push_back(std::move(layer));
      }
    } else if (key != "$comment")
      refuse(path, key,
             "unknown key or wrong type; known are size, atlas, time, depth_mm, sky_rays, libraries, layers");
  }
  if (config.layers.empty()) refuse(path, "layers", "at least one layer is needed");
  return config;
}

std::string layered_recipe(const WeatherConfig& config, const std::string& material, double friction) {
  std::string recipe = fmt::format(
      "multi|textures=[base|colorfunction=currentcolor|bumpfunction=.5+lowerbump|frictionfunction={}]", friction);
  bool any = false;
  for (const WeatherLayer& layer : config.layers)
    for (const std::string& pattern : layer.materials)
      if (::fnmatch(pattern.c_str(), material.c_str(), 0) == 0) {
        recipe += ",[" + layer.recipe + "]";
        any = true;
        break;
      }
  return any ? recipe : "";
}

}  // namespace papilla
