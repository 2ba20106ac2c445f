// SPDX-License-Identifier: MIT
#include "papilla/pipeline/weather_scene.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <unordered_map>

#include "papilla/core/error.hpp"
#include "papilla/core/units.hpp"
#include "papilla/haptic/material_tag.hpp"
#include "papilla/haptic/sha256.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/quantity_maps.hpp"
#include "papilla/pipeline/recipe_source.hpp"
#include "papilla/procedural/texture.hpp"
#include "papilla/texture/normal_map.hpp"
#include "papilla/texture/roughness.hpp"
#include "weather/atlas_uv.hpp"
#include "weather/layered_materials.hpp"
#include "weather/surface_atlas.hpp"
#include "weather/surface_texels.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

/// A material as it was painted.
struct PaintedMaterial {
  std::vector<std::byte> color_png, normal_png;  ///< Empty when not painted.
  std::vector<NewUv> uv;                         ///< Empty when it keeps its coordinates.
  std::optional<HeightTag> height;               ///< Of tagged materials.
  WeatheredMaterial report;
};

/// Which parts the nodes show, and which materials the parts.
std::vector<std::uint32_t> shown_materials(const Scene& scene) {
  std::vector<std::uint32_t> shown;
  for (const Node& node : scene.nodes) shown.push_back(node.part.value_or(std::uint32_t(-1)));
  for (const Part& part : scene.parts) shown.insert(shown.end(), part.materials.begin(), part.materials.end());
  return shown;
}

}  // namespace

struct WeatherCache::State {
  std::map<std::string, PaintedMaterial> painted;
  std::map<std::string, std::shared_ptr<const MaterialSurface>> surfaces;
  std::size_t texels = 0;            ///< Of the surfaces.
  std::optional<StainField> stains;  ///< Made when the first recipe asks for it.
  std::vector<std::uint32_t> shown;  ///< What both were made for: shown_materials().
  std::set<fs::path> files;

  /// Forgets what was made for other surfaces: the layers may lie elsewhere than before.
  void expect(const Scene& scene) {
    std::vector<std::uint32_t> now = shown_materials(scene);
    if (now == shown) return;
    painted.clear(), surfaces.clear(), stains.reset();
    texels = 0;
    shown = std::move(now);
  }
};

namespace {

/// Surfaces are kept for the next time step up to this.
constexpr std::size_t k_most_kept_texels = std::size_t{1} << 26;

/// Of materials without haptic tag: what the recipes' texts take for granted.
constexpr double k_common_friction = 0.4;

/// Everything that stays the same over the materials of a scene.
struct Job {
  const Scene& scene;
  const WeatherConfig& config;
  const std::vector<std::vector<std::uint32_t>>& layers;  ///< Of every material.
  const RecipeLibrary& library;
  double time;
  WeatherCache::State& cache;
  const ProgressCallback& progress;
  std::vector<Instance> all;
  std::optional<SkyView> sky;  ///< Made when the first recipe asks for it.
  std::uint32_t material = 0;  ///< That is being weathered.
};

/// @param done  of the material, in [0, 1].
void report_material(const Job& job, double done) {
  report_progress(job.progress, "weather", (job.material + done) / static_cast<double>(job.scene.materials.size()));
}

/// Shares of a material's time at which its surface is laid out, and its maps are painted.
constexpr double k_laid_out = 0.3, k_painted = 0.8;

/// Adds pictures to a scene, the same bytes once.
class Pictures {
 public:
  explicit Pictures(WeatherResult& result) : result_(result) {}
  TextureReference add(const std::string& name, const std::vector<std::byte>& png) {
    ++result_.images;
    TextureReference reference;
    const auto [it, is_new] = known_.try_emplace(sha256_hex(png), 0);
    if (is_new) {
      Scene& scene = result_.scene;
      EncodedImage encoded;
      encoded.name = name, encoded.mime_type = "image/png", encoded.bytes = png;
      scene.images.push_back(std::move(encoded));
      Texture texture;
      texture.image = static_cast<std::uint32_t>(scene.images.size() - 1), texture.name = name;
      scene.textures.push_back(std::move(texture));
      it->second = static_cast<std::uint32_t>(scene.textures.size() - 1);
    } else {
      ++result_.duplicates_removed;
    }
    reference.texture = it->second;
    return reference;
  }

 private:
  WeatherResult& result_;
  std::map<std::string, std::uint32_t> known_;
};

/// What a window is painted with.
struct PaintJob {
  const ProceduralTexture& texture;
  const SurfaceReading& reading;
  const OwnSurface& own;
  double depth_mm;                     ///< Of a height of 1.
  double friction;                     ///< Without layers.
  bool tiles = false;                  ///< Windows go on round their borders.
  const StainField* stains = nullptr;  ///< Null when the recipe does not read them.
};

/// Sums over the texels that something shows, for the means of the channels.
struct ChannelSums {
  double friction = 0, stiffness = 0, texels = 0;
};

/// A painted window: byte, height, friction and stiffness a texel.
struct Painted {
  int width = 0, height = 0;
  std::vector<unsigned char> rgb;
  std::vector<float> bump, friction, stiffness;

  Painted(int width_px, int height_px, float friction_between)
      : width(width_px),
        height(height_px),
        rgb(3 * texels(), 128),
        bump(texels(), 0.5F),
        friction(texels(), friction_between),
        stiffness(texels(), 1) {}

  std::size_t texels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  friend bool operator==(const Painted&, const Painted&) = default;
};

double flow_at(const StainField& stains, const SurfaceTexels& texels, std::size_t at) {
  const auto vector = [&](const std::vector<float>& from) {
    return Vec3{static_cast<double>(from[3 * at]), static_cast<double>(from[3 * at + 1]),
                static_cast<double>(from[3 * at + 2])};
  };
  return stains(k_mm_per_metre * vector(texels.positions), vector(texels.normals));
}

constexpr unsigned bit(Channel c) { return 1U << static_cast<unsigned>(c); }
constexpr unsigned k_maps = bit(Channel::color) | bit(Channel::bump) | bit(Channel::friction) | bit(Channel::stiffness);

/// Evaluates the recipe at the covered texels of a window; the others get a middle grey and height.
/// @param sky  of the window; empty when it is not read. @param scale  texels a repeat.
/// @param charts  how often the window is shown, for the means.
Painted paint(const PaintJob& job, const SurfaceTexels& texels, const std::vector<float>& sky, double scale,
              double charts, ChannelSums& sums) {
  std::vector<double> x, y;
  std::vector<float> normals, positions, skies, flows, colours, heights;
  std::vector<std::uint32_t> place;
  const auto covered = static_cast<std::size_t>(
      std::count_if(texels.covered.begin(), texels.covered.end(), [](auto c) { return c != 0; }));
  x.reserve(covered), y.reserve(covered), place.reserve(covered), colours.reserve(3 * covered);
  if (!job.reading.directions.empty()) normals.reserve(3 * covered);
  for (int j = 0; j < texels.height; ++j)
    for (int i = 0; i < texels.width; ++i) {
      const std::size_t at = texels.at(texels.left + i, texels.top + j);
      if (!texels.covered[at]) continue;
      place.push_back(static_cast<std::uint32_t>(at));
      x.push_back((texels.left + i + 0.5) / scale), y.push_back((texels.top + j + 0.5) / scale);
      const auto from = static_cast<std::ptrdiff_t>(3 * at);
      if (!job.reading.directions.empty())
        normals.insert(normals.end(), texels.normals.begin() + from, texels.normals.begin() + from + 3);
      if (job.reading.position)
        positions.insert(positions.end(), texels.positions.begin() + from, texels.positions.begin() + from + 3);
      const std::array<float, 3> colour = job.own.colour_at(x.back(), y.back());
      colours.insert(colours.end(), colour.begin(), colour.end());
      if (job.own.has_relief())
        heights.push_back(job.own.height_at(x.back(), y.back()) / static_cast<float>(job.depth_mm));
      if (!sky.empty()) skies.push_back(sky[at]);
      if (job.stains) flows.push_back(static_cast<float>(flow_at(*job.stains, texels, at)));
    }
  TexturePoints points{x, y, normals, positions, skies, colours, heights};
  points.flow = flows;
  if (job.texture.depends_on_neighbours()) points.raster = {texels.width, texels.height, job.tiles, place};
  const TextureValues values = evaluate_texture(job.texture, points, k_maps, 1 / scale);
  const ColorImage image = to_color_image(values[Channel::color], static_cast<int>(place.size()), 1);
  Painted out(texels.width, texels.height, static_cast<float>(job.friction));
  for (std::size_t k = 0; k < place.size(); ++k) {
    std::copy_n(image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * k), 3,
                out.rgb.begin() + static_cast<std::ptrdiff_t>(3 * place[k]));
    out.bump[place[k]] = values[Channel::bump][k];
    out.friction[place[k]] = values[Channel::friction][k];
    out.stiffness[place[k]] = values[Channel::stiffness][k];
    sums.friction += charts * static_cast<double>(values[Channel::friction][k]);
    sums.stiffness += charts * static_cast<double>(values[Channel::stiffness][k]);
    sums.texels += charts;
  }
  return out;
}

std::size_t hash_of(const Painted& tile) {
  const std::hash<std::string_view> hash;
  std::size_t sum = hash({reinterpret_cast<const char*>(tile.rgb.data()), tile.rgb.size()});
  for (const std::vector<float>* values : {&tile.bump, &tile.friction, &tile.stiffness})
    sum = 31 * sum + hash({reinterpret_cast<const char*>(values->data()), values->size() * sizeof(float)});
  return sum;
}

/// Tiles with the same bytes are one, wherever they are shown: found by a hash, and compared.
/// @returns the number of each tile among `distinct`.
std::vector<std::uint32_t> distinct_tiles(std::vector<Painted> painted, std::vector<Painted>& distinct) {
  std::vector<std::uint32_t> number;
  std::unordered_multimap<std::size_t, std::uint32_t> known;
  for (Painted& p : painted) {
    const std::size_t hash = hash_of(p);
    const auto [first, last] = known.equal_range(hash);
    const auto same = std::find_if(first, last, [&](const auto& entry) { return distinct[entry.second] == p; });
    number.push_back(same != last ? same->second : static_cast<std::uint32_t>(distinct.size()));
    if (same != last) continue;
    known.emplace(hash, number.back());
    distinct.push_back(std::move(p));
  }
  return number;
}

/// Copies a tile into the picture.
void copy_tile(const Painted& tile, std::pair<int, int> corner, Painted& picture) {
  for (int row = 0; row < tile.height; ++row) {
    const auto from = static_cast<std::ptrdiff_t>(row) * tile.width;
    const auto to = static_cast<std::ptrdiff_t>(corner.second + row) * picture.width + corner.first;
    for (const auto channel : {&Painted::bump, &Painted::friction, &Painted::stiffness})
      std::copy_n((tile.*channel).begin() + from, tile.width, (picture.*channel).begin() + to);
    std::copy_n(tile.rgb.begin() + 3 * from, 3 * tile.width, picture.rgb.begin() + 3 * to);
  }
}

/// @param report  called with the share of the tiles that are painted.
Painted paint_atlas(const MaterialSurface& shown, const PaintJob& job, ChannelSums& sums, PaintedMaterial& material,
                    const std::function<void(double)>& report) {
  const SurfaceAtlas& atlas = shown.atlas;
  const std::vector<SurfaceTriangle>& surface = shown.triangles;
  std::vector<Painted> painted, distinct;
  for (const AtlasTile& tile : atlas.tiles) {
    painted.push_back(
        paint(job, tile.texels, tile.sky, atlas.texels_per_repeat, static_cast<double>(tile.charts), sums));
    report(static_cast<double>(painted.size()) / static_cast<double>(atlas.tiles.size()));
  }
  const std::vector<std::uint32_t> number = distinct_tiles(std::move(painted), distinct);
  std::vector<std::pair<int, int>> sizes;
  for (const Painted& p : distinct) sizes.emplace_back(p.width, p.height);
  const TilePlaces places = place_tiles(sizes);
  Painted picture(places.width, places.height, static_cast<float>(job.friction));
  for (std::size_t k = 0; k < distinct.size(); ++k) copy_tile(distinct[k], places.corner[k], picture);
  for (std::size_t t = 0; t < surface.size(); ++t) {
    const AtlasChart& chart = atlas.charts[atlas.chart_of[t]];
    const auto [x, y] = places.corner[number[chart.tile]];
    NewUv fresh{surface[t].instance, surface[t].triangle, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 at = atlas.texels_per_repeat * surface[t].uv[k];
      fresh.uv[k] = {(at.x - chart.left + x) / picture.width, 1 - (at.y - chart.top + y) / picture.height};
    }
    material.uv.push_back(fresh);
  }
  material.report.atlas = {picture.width,      picture.height,  atlas.charts.size(),
                           atlas.tiles.size(), distinct.size(), atlas.texels_per_repeat};
  return picture;
}

/// The friction and stiffness of a new surface.
void set_haptic_constants(MaterialTag& tag, double friction, double factor) {
  const double ratio = tag.dynamic_friction > 0 ? tag.static_friction / tag.dynamic_friction : 1;
  tag.dynamic_friction = friction, tag.static_friction = ratio * friction;
  tag.stiffness *= factor;
}

/// Gives a tagged material the maps of its layers, on the coordinates of what was painted. A relief that stays on other
/// ones leaves no place for them: they become constants.
void assign_maps(Material& material, MapsTag maps, std::vector<std::string>& losses) {
  if (!material.haptic) return;
  const TextureReference& place = *material.base_color_texture;
  if (material.haptic->height && material.haptic->height->tex_coord != place.tex_coord) {
    losses.push_back(
        fmt::format("material '{}': where its layers change friction and stiffness, which are means over "
                    "the surface, for its relief lies on other coordinates",
                    material.name));
    return;
  }
  maps.tex_coord = place.tex_coord;
  if (place.transform) maps.uv_transform = *place.transform;
  material.haptic->maps = std::move(maps);
}

/// Gives a tagged material a relief that lies on the coordinates of its normal map.
void assign_relief(Material& material, HeightTag height) {
  if (!material.haptic) return;
  if (const auto& place = material.normal_texture) {
    height.tex_coord = place->tex_coord;
    if (place->transform) {
      height.uv_transform = *place->transform;
      // Before the transform; a repeat is 1 / scale of the uv.
      height.metres_per_uv = {height.metres_per_uv.x * std::abs(place->transform->scale.x),
                              height.metres_per_uv.y * std::abs(place->transform->scale.y)};
    }
  }
  if (auto& roughness = material.haptic->roughness; roughness && !roughness->overlay)
    roughness->rms_height_m = height.rms_m;
  material.haptic->height = std::move(height);
}

/// Everything that a material's look depends on apart from the scene.
std::string key_of(const Job& job, std::uint32_t index, const std::string& recipe, const ProceduralTexture& texture,
                   const std::vector<fs::path>& pictures) {
  std::string key =
      fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}", index, job.config.size, job.config.atlas_side(), job.config.depth_mm,
                  job.config.sky_rays, texture.depends_on_time() ? job.time : 0, recipe);
  for (const std::string& name : texture.recipes_used()) key += '\n' + name + ' ' + *job.library.find(name);
  for (const fs::path& picture : pictures) {
    std::error_code error;
    key += fmt::format("\n{} {} {}", picture.string(), fs::last_write_time(picture, error).time_since_epoch().count(),
                       fs::file_size(picture, error));
  }
  return key;
}

/// The material's surface, from the cache if it was laid out for such a reading before.
std::shared_ptr<const MaterialSurface> surface_for(Job& job, std::uint32_t index, const SurfaceReading& reading) {
  std::string key = fmt::format("{} {} {} {} {} {}", index, job.config.size, job.config.atlas_side(), reading.position,
                                reading.sky, reading.sky ? job.config.sky_rays : 0);
  for (const auto& d : reading.directions) key += fmt::format(" {} {} {}", d[0], d[1], d[2]);
  if (const auto it = job.cache.surfaces.find(key); it != job.cache.surfaces.end()) return it->second;
  const auto surface = std::make_shared<const MaterialSurface>(
      lay_out(job.scene, job.all, index, job.config.size, job.config.atlas_side(), reading, [&]() -> const SkyView& {
        if (!job.sky) job.sky = sky_of(job.scene, job.all, job.config.sky_rays);
        return *job.sky;
      }));
  if (job.cache.texels + surface->texels() <= k_most_kept_texels) {
    job.cache.texels += surface->texels();
    job.cache.surfaces.emplace(std::move(key), surface);
  }
  return surface;
}

/// Paints one material anew.
/// @param tag  that it had. @param compiled  compiles the recipe, seamless or not.
PaintedMaterial paint_material(Job& job, std::uint32_t index, const std::optional<MaterialTag>& tag,
                               const ProceduralTexture& texture,
                               const std::function<ProceduralTexture(bool)>& compiled) {
  PaintedMaterial material;
  WeatheredMaterial& report = material.report;
  const SurfaceReading reading{texture.dirt_directions(), texture.depends_on_position() || texture.depends_on_flow(),
                               texture.depends_on_sky()};
  std::optional<StainField>& known = job.cache.stains;
  if (texture.depends_on_flow() && !known) known = stains_of(job.scene, job.all);
  const StainField* stains = texture.depends_on_flow() ? &*known : nullptr;
  const auto surface = surface_for(job, index, reading);
  report_material(job, k_laid_out);
  if (!(surface->mm_per_repeat > 0)) {
    report.skipped = "no surface with uv shows it";
    return material;
  }
  ChannelSums means;
  Painted picture(0, 0, 0);
  const double friction = tag ? tag->dynamic_friction : k_common_friction;
  double scale = job.config.size;
  if (surface->repeat) {
    const bool tiles = surface->leaves_the_repeat();
    const ProceduralTexture tiling = tiles ? compiled(true) : texture;
    picture = paint({tiling, reading, *surface->own, job.config.depth_mm, friction, tiles, stains}, *surface->repeat,
                    surface->sky, scale, 1, means);
  } else {
    scale = surface->atlas.texels_per_repeat;
    picture =
        paint_atlas(*surface, {texture, reading, *surface->own, job.config.depth_mm, friction, false, stains}, means,
                    material, [&](double done) { report_material(job, k_laid_out + done * (k_painted - k_laid_out)); });
  }
  const double pitch = surface->mm_per_repeat / scale;
  report.keeps_relief = surface->keeps_relief;
  if (tag) {
    QuantityMaps maps{picture.width, picture.height, pitch, pitch, surface->repeat.has_value(), {}};
    maps.maps = {{Quantity::stiffness, std::move(picture.stiffness)},
                 {Quantity::dynamic_friction, std::move(picture.friction)}};
    for (float& v : maps.maps[0].values) v *= static_cast<float>(tag->stiffness);
    report.maps = encode_quantity_maps(std::move(maps));
  }
  if (!report.keeps_relief) {
    HeightMap relief{picture.width, picture.height, std::move(picture.bump), pitch, pitch, surface->repeat.has_value()};
    // A height of 1/2 is the surface as it was.
    for (float& h : relief.mm) h = (h - 0.5F) * static_cast<float>(job.config.depth_mm);
    if (tag && (!tag->height || surface->own->has_relief())) {
      const EncodedHeight encoded = encode_height_png16(relief);
      material.height = make_height_tag(relief, {.png = encoded.png,
                                                 .scale_mm = encoded.scale_mm,
                                                 .offset_mm = encoded.offset_mm,
                                                 .rms_mm = rms_height_mm(relief)});
    }
    material.normal_png = encode_png(normal_map(relief));
  }
  material.color_png = encode_png({picture.width, picture.height, std::move(picture.rgb)});
  report.friction = means.friction / means.texels, report.stiffness = means.stiffness / means.texels;
  report.depends_on_normal = texture.depends_on_normal(), report.depends_on_position = reading.position;
  report.depends_on_sky = reading.sky, report.depends_on_neighbours = texture.depends_on_neighbours();
  report.uses = texture.recipes_used();
  report.own_relief = surface->own->has_relief();
  report.mm_per_texel = pitch;
  return material;
}

/// Gives the material the maps that were painted.
void apply(const PaintedMaterial& painted, Material& material, Pictures& pictures, std::vector<std::string>& losses) {
  TextureReference place;
  if (const TextureReference* own = own_place(material); painted.uv.empty() && own) place = *own;
  for (auto* reference : {&material.base_color_texture, &material.normal_texture}) {
    const bool colour = reference == &material.base_color_texture;
    if (!colour && painted.report.keeps_relief) continue;
    *reference =
        pictures.add((colour ? "color." : "normal.") + material.name, colour ? painted.color_png : painted.normal_png);
    (*reference)->transform = place.transform, (*reference)->tex_coord = place.tex_coord;
  }
  material.base_color = {1, 1, 1, material.base_color[3]};
  if (material.haptic && material.haptic->maps) {
    losses.push_back(
        fmt::format("material '{}': its own maps of stiffness, friction and damping, over which its "
                    "layers lie as if they were constant",
                    material.name));
    material.haptic->maps.reset();
  }
  if (material.haptic) set_haptic_constants(*material.haptic, painted.report.friction, painted.report.stiffness);
}

/// What a weathered material gets for the hand.
struct FeltMaps {
  std::optional<HeightTag> height;
  std::optional<MapsTag> maps;
};

/// Weathers one material. @return what is reported of it.
WeatheredMaterial weather_material(WeatherResult& result, std::uint32_t index, Job& job, Pictures& pictures,
                                   std::vector<NewUv>& uv, std::vector<AtlasMaterial>& with_atlas,
                                   std::vector<FeltMaps>& felt) {
  const Material& before = job.scene.materials[index];
  const std::optional<MaterialTag>& tag = before.haptic;
  const std::string recipe =
      layered_recipe(job.config, job.layers[index], tag ? tag->dynamic_friction : k_common_friction);
  WeatheredMaterial report;
  report.name = before.name, report.recipe = recipe;
  if (recipe.empty()) return report;
  CompileOptions options = recipe_options(job.config.folder);
  options.time = job.time, options.source = "weather, material '" + before.name + "'";
  std::vector<fs::path> read;
  options.read_picture = [&read, &job, from = options.read_picture](const std::string& path) {
    read.push_back(job.config.folder / path);
    job.cache.files.insert(read.back());
    return from(path);
  };
  options.target_px = job.config.size;
  const auto compiled = [&](bool seamless) {
    options.seamless = seamless;
    return compile_texture(recipe, job.library, options);
  };
  const ProceduralTexture texture = compiled(false);
  const std::string key = key_of(job, index, recipe, texture, read);
  auto it = job.cache.painted.find(key);
  if (it == job.cache.painted.end()) {
    it = job.cache.painted.emplace(key, paint_material(job, index, tag, texture, compiled)).first;
    ++result.painted;
  }
  const PaintedMaterial& painted = it->second;
  report = painted.report;
  report.name = before.name, report.recipe = recipe;
  if (!report.painted()) return report;
  apply(painted, result.scene.materials[index], pictures, result.scene.losses);
  uv.insert(uv.end(), painted.uv.begin(), painted.uv.end());
  if (!painted.uv.empty()) with_atlas.push_back({index, report.keeps_relief});
  if (report.keeps_relief)
    result.scene.losses.push_back(fmt::format(
        "material '{}': the relief of the layers; its atlas of {:.2g} mm a texel would blur its own, which stays",
        before.name, report.mm_per_texel));
  felt[index] = {painted.height, painted.report.maps};
  return report;
}

}  // namespace

WeatherCache::WeatherCache() : state_(std::make_unique<State>()) {}
WeatherCache::~WeatherCache() = default;
WeatherCache::WeatherCache(WeatherCache&&) noexcept = default;
WeatherCache& WeatherCache::operator=(WeatherCache&&) noexcept = default;

const std::set<fs::path>& WeatherCache::files() const noexcept { return state_->files; }
std::size_t WeatherCache::surfaces() const noexcept { return state_->surfaces.size(); }

WeatherResult weather_scene(const Scene& scene, const WeatherConfig& config, double time, WeatherCache& cache,
                            const ProgressCallback& progress) {
  RecipeLibrary library = RecipeLibrary::builtin();
  const auto note_files = [&] { cache.state().files.insert(library.files().begin(), library.files().end()); };
  try {
    for (std::size_t i = 0; i < config.libraries.size(); ++i)
      library.include(config.libraries[i], fmt::format("{}: at /libraries/{}", config.source, i), config.folder);
  } catch (const Error&) {
    note_files();
    throw;
  }
  note_files();
  WeatherResult result;
  const LayeredScene layered = layer_materials(scene, config);
  std::vector<std::string> problems = problems_of(layered.uses, "layer", "/layers");
  if (config.strict && !problems.empty()) throw InvalidInput(config.source + ": " + problems.front());
  const Scene& before = layered.scene ? *layered.scene : scene;
  cache.state().expect(before);
  result.scene = before;
  result.layers = layered.uses;
  for (std::string& problem : problems) result.scene.warnings.push_back(std::move(problem));
  Pictures pictures(result);
  Job job{before, config, layered.layers, library, time, cache.state(), progress, instances(before), {}};
  std::vector<NewUv> uv;
  std::vector<AtlasMaterial> with_atlas;
  std::vector<FeltMaps> felt(before.materials.size());
  for (std::uint32_t m = 0; m < before.materials.size(); ++m) {
    job.material = m;
    report_material(job, 0);
    result.materials.push_back(weather_material(result, m, job, pictures, uv, with_atlas, felt));
  }
  if (!with_atlas.empty()) set_atlas_uv(result.scene, job.all, std::move(uv), with_atlas);
  for (std::size_t m = 0; m < felt.size(); ++m) {
    Material& material = result.scene.materials[m];
    if (felt[m].height) assign_relief(material, std::move(*felt[m].height));
    if (felt[m].maps) assign_maps(material, std::move(*felt[m].maps), result.scene.losses);
  }
  return result;
}

std::string reason_for_no_paint(const WeatherResult& result) {
  const auto any = [&](auto&& is_so) { return std::any_of(result.materials.begin(), result.materials.end(), is_so); };
  if (any([](const WeatheredMaterial& m) { return m.painted(); })) return "";
  if (result.materials.empty()) return "has no material that a layer could lie on";
  const std::vector<Part>& parts = result.scene.parts;
  if (std::all_of(parts.begin(), parts.end(), [](const Part& part) { return part.mesh.uv.indices.empty(); }))
    return "has no texture coordinates, which the layers need; 'papilla unwrap' makes them";
  if (any([](const WeatheredMaterial& m) { return !m.skipped.empty(); }))
    return "no surface that a layer lies on has texture coordinates, which it needs; 'papilla unwrap' makes them";
  const std::vector<std::string> problems = problems_of(result.layers, "layer", "/layers");
  return "no layer lies on any surface" + (problems.empty() ? "" : "; " + problems.front());
}

WeatherResult weather_scene(const Scene& scene, const WeatherConfig& config, double time,
                            const ProgressCallback& progress) {
  WeatherCache cache;
  return weather_scene(scene, config, time, cache, progress);
}

}  // namespace papilla
