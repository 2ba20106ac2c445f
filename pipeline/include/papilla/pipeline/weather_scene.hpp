// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/haptic/material_tag.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/pipeline/surface_selector.hpp"

namespace papilla {

/// A recipe that is laid over the surfaces that are selected.
struct WeatherLayer {
  std::string recipe;
  std::vector<std::string> materials{"*"};  ///< Shell patterns, one of which the material's name must fit.
  SurfaceSelector where{};                  ///< Must fit, too.
};

/// CONFIG of the verb weather.
struct WeatherConfig {
  int size = 512;                      ///< Texels a side of one repeat of a material's maps.
  int atlas = 0;                       ///< Texels a side of an atlas at most; 0: four times `size`.
  std::vector<double> times{1};        ///< A scene for each.
  double depth_mm = 0.3;               ///< Relief of a height of 1.
  int sky_rays = 64;                   ///< A sample of the sky.
  std::vector<std::string> libraries;  ///< Files of recipes in the folder or below it.
  std::vector<WeatherLayer> layers;    ///< From the lowest to the highest.
  std::filesystem::path folder;        ///< Where the names within are looked for.
  std::string source = "weather";      ///< The configuration's name in messages.
  bool strict = false;                 ///< A layer that lies on no surface is an error; no key of the file.
  /// Charts that come out alike do not share their texels, so that coordinates depend on the surfaces and on what the
  /// recipes read of them alone; no key of the file.
  bool stable_layout = false;

  int atlas_side() const { return atlas > 0 ? atlas : 4 * size; }
};

/// @throws IoError, InvalidInput naming file and key.
WeatherConfig read_weather_config(const std::filesystem::path& path);

/// The layers of these numbers over what a material has of its own, as one recipe; empty without any.
std::string layered_recipe(const WeatherConfig& config, const std::vector<std::uint32_t>& layers, double friction);

/// The atlas of a material that was cut into charts.
struct WeatheredAtlas {
  int width = 0, height = 0;
  std::size_t charts = 0;
  std::size_t tiles_computed = 0, tiles = 0;  ///< Tiles that look different to the recipe; those that differ in bytes.
  double texels_per_repeat = 0;
};

/// What became of one material.
struct WeatheredMaterial {
  std::string name;
  std::string recipe;   ///< All layers over its own surface; empty: no layer fits and it stays as it is.
  std::string skipped;  ///< Why it was not painted although a layer fits; empty when it was.
  std::optional<WeatheredAtlas> atlas;  ///< Without: its maps cover one repeat of its own uv.
  bool depends_on_normal = false, depends_on_position = false, depends_on_sky = false, depends_on_neighbours = false;
  std::vector<std::string> uses;  ///< Recipes of the libraries.
  bool own_relief = false;        ///< Its normal map was read as relief below the layers.
  bool keeps_relief = false;      ///< Its own relief stays as it was, without the layers'.
  double mm_per_texel = 0;
  /// Means of the channels; stiffness and damping are factors.
  double friction = 0, stiffness = 1, damping = 1, roughness = 1, metallic = 0, alpha = 1;
  std::optional<MapsTag> maps;  ///< Of a tagged material, where they differ from place to place.

  bool painted() const { return !recipe.empty() && skipped.empty(); }
};

struct WeatherResult {
  Scene scene;
  /// Of the scene. Behind those that it had before come copies of the ones that layers lie on only here and there.
  std::vector<WeatheredMaterial> materials;
  std::vector<RuleUse> layers;  ///< Of every layer; problems are warnings of the scene, too.
  int images = 0, duplicates_removed = 0;
  int painted = 0;  ///< Materials that were computed; the others came out of the cache.
};

/// What was painted for one scene, by all that it depends on but the scene, and the surfaces it was painted on, which
/// are the same at every time.
class WeatherCache {
 public:
  WeatherCache();
  ~WeatherCache();
  WeatherCache(WeatherCache&&) noexcept;
  WeatherCache& operator=(WeatherCache&&) noexcept;

  /// Libraries, what they include, pictures: all that was ever read.
  const std::set<std::filesystem::path>& files() const noexcept;

  /// Surfaces that are laid out and kept: one a material and reading.
  std::size_t surfaces() const noexcept;

  struct State;
  State& state() noexcept { return *state_; }

 private:
  std::unique_ptr<State> state_;
};

/// How a painted material is seen, as pixels: RGBA of 8 bits, row by row from the top, of one size.
struct WeatheredLook {
  int width = 0, height = 0;
  std::vector<unsigned char> color, normal, shine;  ///< glTF's pictures; empty where there is none.
  double roughness = 1, metallic = 0, opacity = 1;  ///< Factors.
  std::string alpha_mode;
};

struct WeatherLooks {
  std::vector<std::shared_ptr<const WeatheredLook>> materials;  ///< As of WeatherResult::scene; null: not painted.
  /// Differs where the scene that weather_scene() makes has other parts, materials, coordinates or sizes of pictures.
  std::string layout;
  int painted = 0;  ///< Materials that were computed; the looks of the others are the same objects as before.
};

/// Why nothing was painted: no layer fits a surface, or those it fits have no uv. Empty when something was.
std::string reason_for_no_paint(const WeatherResult& result);

/// What weather_scene() would show, without the files and the haptic maps: for whoever draws the scene already. The
/// cache keeps what is shown now, and nothing older. A progress callback that returns false ends it by Cancelled, as of
/// weather_scene().
/// @pre stable_layout. @throws as weather_scene().
WeatherLooks weather_looks(const Scene& scene, const WeatherConfig& config, double time, WeatherCache& cache,
                           const ProgressCallback& progress = {});

/// Lays the layers over the materials' own colour, alpha, roughness, metallic and the relief of their own normal maps
/// at one time; each material gets a base colour, a normal map and a metallic-roughness picture, and its haptic tag
/// maps of friction, stiffness and damping, where the layers' channels differ from place to place
/// (encode_quantity_maps()), with their means as constants. The channel reflection is metallic, the channel roughness
/// is roughness, which a recipe may leave to its highlight (roughness_of_highlight()); diffuse scales the base colour
/// in linear light where it is no metal. Alpha below 1 where a material was opaque is a hole: alphaMode MASK at 1/2.
/// Own maps are replaced, and where an own relief stays on other coordinates there are only the means (losses of the
/// result). The tag's height map is replaced by the new relief, 0 where no layer is over a flat material, unless it
/// lies on coordinates of its own.
///
/// Every texel knows the interpolated normal, the position and the sky of the surface that shows it. A material whose
/// recipe reads none of them, or whose uv show no texel twice, keeps its uv; its maps cover one repeat. The others are
/// cut into charts that get an atlas of their own, with new texture coordinates: charts that look the same to the
/// recipe share their texels. Its resolution is `size` texels a repeat, or less to stay within atlas_side(). An own
/// relief that would be blurred then, its normal map and the tag's height map, stays as it was, without that of the
/// layers (a loss of the result). What else lies on the old coordinates (other pictures, the haptic height map) goes to
/// the second ones. Maps that cover one repeat are seamless where the uv leave it. An own normal map that lies on other
/// coordinates than the colour is replaced. Materials without uv, or that no layer fits, stay as they are and are named
/// in the result.
/// @param cache Materials that have been painted with the same recipes before are taken from it; belongs to this scene.
/// @throws InvalidInput for a recipe that is none, naming it, and for strict layers before anything is painted.
WeatherResult weather_scene(const Scene& scene, const WeatherConfig& config, double time, WeatherCache& cache,
                            const ProgressCallback& progress = {});
WeatherResult weather_scene(const Scene& scene, const WeatherConfig& config, double time,
                            const ProgressCallback& progress = {});

}  // namespace papilla
