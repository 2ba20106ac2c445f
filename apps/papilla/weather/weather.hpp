// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "papilla/haptic/material_tag.hpp"
#include "papilla/io/scene.hpp"
#include "verb.hpp"
#include "weather/atlas_uv.hpp"
#include "weather/material_surface.hpp"
#include "weather/weather_config.hpp"

namespace papilla::app {

struct WeatherResult {
  Scene scene;
  Json materials = Json::array();
  int images = 0, duplicates_removed = 0;
  int painted = 0;  ///< Materials that were computed; the others came out of the cache.
};

/// A material as it was painted.
struct AgedMaterial {
  std::vector<std::byte> color_png, normal_png;  ///< Empty when nothing was painted.
  std::vector<NewUv> uv;                         ///< Empty when it keeps its coordinates.
  double friction = 0, stiffness = 1;
  std::optional<HeightTag> height;  ///< Of tagged materials.
  Json json = Json::object();
};

/// What was painted for one scene, by all that it depends on but the scene, and the surfaces it was painted on, which
/// are the same at every time.
struct WeatherCache {
  std::map<std::string, AgedMaterial> aged;
  std::map<std::string, std::shared_ptr<const MaterialSurface>> surfaces;
  std::size_t texels = 0;                 ///< Of the surfaces.
  std::set<std::filesystem::path> files;  ///< Libraries, what they include, pictures: all that was ever read.
};

/// Lays the layers over the materials' own colour and the relief of their own normal maps at one time; each material
/// gets a base colour and a normal map, and the friction and stiffness of its haptic tag follow the means of the
/// layers' channels. The tag's height map is
/// replaced by the new relief, 0 where no layer is over a flat material, unless it lies on coordinates of its own.
///
/// Every texel knows the interpolated normal, the position and the sky of the surface that shows it. A material whose
/// recipe reads none of them, or whose uv show no texel twice, keeps its uv; its maps cover one repeat. The others are
/// cut into charts that get an atlas of their own, with new texture coordinates: charts that look the same to the
/// recipe share their texels. What else lies on the old coordinates (other pictures, the haptic height map) goes to the
/// second ones. Maps that cover one repeat are seamless where the uv leave it. An own normal map that lies on other
/// coordinates than the colour is replaced. Materials without uv, or that no layer fits, stay as they are and are named
/// in the result.
/// @throws InvalidInput for a recipe that is none, naming it.
WeatherResult weather(const Scene& scene, const WeatherConfig& config, double time);

/// The same, and materials that have been painted with the same recipes before are taken from `cache`, which belongs to
/// this scene.
WeatherResult weather(const Scene& scene, const WeatherConfig& config, double time, WeatherCache& cache);

}  // namespace papilla::app
