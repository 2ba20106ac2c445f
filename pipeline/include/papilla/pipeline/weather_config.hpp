// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace papilla {

/// A recipe that is laid over the materials whose names fit one of the shell patterns.
struct WeatherLayer {
  std::string recipe;
  std::vector<std::string> materials{"*"};
};

/// CONFIG of the verb weather.
struct WeatherConfig {
  int size = 512;                      ///< Texels a side of one repeat of a material's maps.
  int atlas = 0;                       ///< Texels a side of an atlas at most; 0: four times `size`.
  std::vector<double> times{1};        ///< A scene for each.
  double depth_mm = 0.3;               ///< Relief of a height of 1.
  int sky_rays = 64;                   ///< A sample of the sky.
  std::vector<std::string> libraries;  ///< Files of recipes.
  std::vector<WeatherLayer> layers;    ///< From the lowest to the highest.
  std::filesystem::path folder;        ///< Where the names within are looked for.

  int atlas_side() const { return atlas > 0 ? atlas : 4 * size; }
};

/// @throws IoError, InvalidInput naming file and key.
WeatherConfig read_weather_config(const std::filesystem::path& path);

/// The layers that fit a material of that name, over its own colour, friction and stiffness, as one recipe; empty when
/// none fits.
std::string layered_recipe(const WeatherConfig& config, const std::string& material, double friction);

}  // namespace papilla
