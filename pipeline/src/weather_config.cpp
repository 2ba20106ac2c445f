// SPDX-License-Identifier: MIT
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "json_value.hpp"
#include "papilla/core/error.hpp"
#include "papilla/pipeline/weather_scene.hpp"
#include "papilla/procedural/ageing.hpp"

namespace papilla {
namespace {

/// The layer of a recipe, or those that words of ageing stand for.
std::vector<WeatherLayer> read_layers(const JsonValue& value) {
  WeatherLayer layer;
  layer.where = read_selector(value, {"recipe", "age", "materials", "not", "$comment"});
  if (const auto v = value.get("materials")) layer.materials = v->texts();
  const auto age = value.get("age");
  if (!age) {
    layer.recipe = value.require("recipe").text();
    return {layer};
  }
  if (value.get("recipe")) age->fail("stands beside a recipe; one layer has one of them");
  std::vector<WeatherLayer> layers;
  try {
    for (const AgeingLayer& ageing : ageing_layers(age->text())) {
      layer.recipe = ageing.text();
      layers.push_back(layer);
    }
  } catch (const InvalidInput& refusal) {
    age->fail(refusal.what());
  }
  return layers;
}

}  // namespace

WeatherConfig read_weather_config(const std::filesystem::path& path) {
  const JsonValue::Json json = read_json(path);
  const JsonValue root(json, path.string(), "");
  root.expect_keys({"size", "atlas", "time", "depth_mm", "sky_rays", "libraries", "layers", "$comment"});
  WeatherConfig config;
  config.folder = path.parent_path();
  config.source = path.string();
  if (const auto v = root.get("size")) config.size = static_cast<int>(v->number(16, 8192));
  if (const auto v = root.get("atlas")) config.atlas = static_cast<int>(v->number(64, 8192));
  if (const auto v = root.get("sky_rays")) config.sky_rays = static_cast<int>(v->number(1, 4096));
  if (const auto v = root.get("depth_mm")) config.depth_mm = v->number(1e-6, 100);
  if (const auto v = root.get("time"); v && v->json().is_array()) {
    if (v->json().empty()) v->fail("at least one time is needed");
    config.times.clear();
    for (const JsonValue& time : v->list()) config.times.push_back(time.number(0, 1));
  } else if (v) {
    config.times = {v->number(0, 1)};
  }
  if (const auto v = root.get("libraries")) config.libraries = v->texts();
  const JsonValue layers = root.require("layers");
  for (const JsonValue& value : layers.list())
    for (WeatherLayer& layer : read_layers(value)) config.layers.push_back(std::move(layer));
  if (config.layers.empty()) layers.fail("at least one layer is needed");
  return config;
}

std::string layered_recipe(const WeatherConfig& config, const std::vector<std::uint32_t>& layers, double friction) {
  if (layers.empty()) return "";
  std::string recipe = fmt::format(
      "multi|textures=[base|colorfunction=currentcolor|bumpfunction=.5+lowerbump|frictionfunction={}"
      "|alphafunction=loweralpha|reflectionfunction=lowerreflection|roughnessfunction=lowerroughness"
      "|specularfunction=1|specularcoefffunction=2/max(lowerroughness,.01)^4-2]",
      friction);
  for (const std::uint32_t layer : layers) recipe += ",[" + config.layers.at(layer).recipe + "]";
  return recipe;
}

}  // namespace papilla
