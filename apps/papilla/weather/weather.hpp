// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "papilla/io/scene.hpp"
#include "verb.hpp"

namespace papilla::app {

/// A recipe that is laid over the materials whose names fit one of the shell patterns.
struct WeatherLayer {
  std::string recipe;
  std::vector<std::string> materials{"*"};
};

/// CONFIG of the verb weather.
struct WeatherConfig {
  int size = 512;                      ///< Texels a side of a material's maps.
  std::vector<double> times{1};        ///< A scene for each.
  double depth_mm = 0.3;               ///< Relief of a height of 1.
  std::vector<std::string> libraries;  ///< Files of recipes.
  std::vector<WeatherLayer> layers;    ///< From the lowest to the highest.
  std::filesystem::path folder;        ///< Where the names within are looked for.
};

/// @throws IoError, InvalidInput naming file and key.
WeatherConfig read_weather_config(const std::filesystem::path& path);

struct WeatherResult {
  Scene scene;
  Json materials = Json::array();
  int images = 0, duplicates_removed = 0;
};

/// Lays the layers over the materials' own colour at one time. Every material keeps its uv; its maps cover one repeat
/// of it, and each texel knows the interpolated normal and the position of the surface that shows it (the first one
/// where several do). Materials without uv, or that no layer fits, stay as they are and are named in the result.
/// @throws InvalidInput for a recipe that is none, naming it.
WeatherResult weather(const Scene& scene, const WeatherConfig& config, double time);

}  // namespace papilla::app
