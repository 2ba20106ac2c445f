// SPDX-License-Identifier: GPL-3.0-or-later
#include "weather/weather.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "papilla/haptic/material_tag.hpp"
#include "papilla/haptic/sha256.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/procedural/texture.hpp"
#include "papilla/texture/normal_map.hpp"
#include "recipe_source.hpp"
#include "weather/atlas_uv.hpp"
#include "weather/own_colour.hpp"
#include "weather/sky_texels.hpp"
#include "weather/surface_atlas.hpp"

namespace papilla::app {
namespace {

constexpr unsigned bit(Channel c) { return 1U << static_cast<unsigned>(c); }
constexpr unsigned k_maps = bit(Channel::color) | bit(Channel::bump) | bit(Channel::friction) | bit(Channel::stiffness);
/// Of materials without haptic tag: what the recipes' texts take for granted.
constexpr double k_common_friction = 0.4;

/// Sums over the texels that something shows, so that means can be told.
struct Felt {
  double friction = 0, stiffness = 0, texels = 0;
};

/// A painted window: byte and height a texel.
struct Painted {
  int width = 0, height = 0;
  std::vector<unsigned char> rgb;
  std::vector<float> bump;
};

/// Everything that stays the same over the materials of a scene.
struct Job {
  const Scene& scene;
  const WeatherConfig& config;
  const RecipeLibrary& library;
  double time;
  std::vector<Instance> all;
  std::optional<SkyView> sky;  ///< Made when the first recipe asks for it.
};

/// Evaluates the recipe at the covered texels of a window; the others get the material's middle.
/// @param charts  how often the window is shown, for the means.
Painted paint(const ProceduralTexture& texture, const SurfaceReading& reading, const SurfaceTexels& texels,
              const std::vector<float>& sky, const OwnColour& own, double scale, double charts, Felt& felt) {
  std::vector<double> x, y;
  std::vector<float> normals, positions, skies, colours;
  std::vector<std::size_t> place;
  for (int j = 0; j < texels.height; ++j)
    for (int i = 0; i < texels.width; ++i) {
      const std::size_t at = texels.at(texels.left + i, texels.top + j);
      if (!texels.covered[at]) continue;
      place.push_back(at);
      x.push_back((texels.left + i + 0.5) / scale), y.push_back((texels.top + j + 0.5) / scale);
      const auto from = static_cast<std::ptrdiff_t>(3 * at);
      if (!reading.directions.empty())
        normals.insert(normals.end(), texels.normals.begin() + from, texels.normals.begin() + from + 3);
      if (reading.position)
        positions.insert(positions.end(), texels.positions.begin() + from, texels.positions.begin() + from + 3);
      const std::array<float, 3> colour = own.at(x.back(), y.back());
      colours.insert(colours.end(), colour.begin(), colour.end());
      if (!sky.empty()) skies.push_back(sky[at]);
    }
  const TextureValues values = evaluate_texture(texture, {x, y, normals, positions, skies, colours}, k_maps, 1 / scale);
  const ColorImage image = to_color_image(values[Channel::color], static_cast<int>(place.size()), 1);
  Painted out{texels.width, texels.height, std::vector<unsigned char>(3 * texels.count(), 128),
              std::vector<float>(texels.count(), 0.5F)};
  for (std::size_t k = 0; k < place.size(); ++k) {
    std::copy_n(image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * k), 3,
                out.rgb.begin() + static_cast<std::ptrdiff_t>(3 * place[k]));
    out.bump[place[k]] = values[Channel::bump][k];
    felt.friction += charts * static_cast<double>(values[Channel::friction][k]);
    felt.stiffness += charts * static_cast<double>(values[Channel::stiffness][k]);
    felt.texels += charts;
  }
  return out;
}

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

/// Tiles with the same bytes are one, wherever they are shown. @returns the number of each tile among `unlike`.
std::vector<std::uint32_t> unlike_tiles(std::vector<Painted> painted, std::vector<Painted>& unlike) {
  std::vector<std::uint32_t> number;
  std::map<std::string, std::uint32_t> known;
  for (Painted& p : painted) {
    const std::string hash = std::to_string(p.width) + sha256_hex(std::as_bytes(std::span(p.rgb))) +
                             sha256_hex(std::as_bytes(std::span(p.bump)));
    const auto [it, is_new] = known.try_emplace(hash, static_cast<std::uint32_t>(unlike.size()));
    if (is_new) unlike.push_back(std::move(p));
    number.push_back(it->second);
  }
  return number;
}

/// Copies a tile into the picture.
void put(const Painted& tile, std::pair<int, int> corner, Painted& picture) {
  for (int row = 0; row < tile.height; ++row) {
    const auto from = static_cast<std::ptrdiff_t>(row) * tile.width;
    const auto to = static_cast<std::ptrdiff_t>(corner.second + row) * picture.width + corner.first;
    std::copy_n(tile.bump.begin() + from, tile.width, picture.bump.begin() + to);
    std::copy_n(tile.rgb.begin() + 3 * from, 3 * tile.width, picture.rgb.begin() + 3 * to);
  }
}

Painted paint_atlas(const SurfaceAtlas& atlas, std::span<const SurfaceTriangle> surface,
                    const ProceduralTexture& texture, const SurfaceReading& reading, const OwnColour& own, Felt& felt,
                    std::vector<NewUv>& uv, Json& json) {
  std::vector<Painted> painted, unlike;
  for (const AtlasTile& tile : atlas.tiles)
    painted.push_back(paint(texture, reading, tile.texels, tile.sky, own, atlas.texels_per_repeat,
                            static_cast<double>(tile.charts), felt));
  const std::vector<std::uint32_t> number = unlike_tiles(std::move(painted), unlike);
  std::vector<std::pair<int, int>> sizes;
  for (const Painted& p : unlike) sizes.emplace_back(p.width, p.height);
  const TilePlaces places = place_tiles(sizes);
  const std::size_t texels = static_cast<std::size_t>(places.width) * static_cast<std::size_t>(places.height);
  Painted picture{places.width, places.height, std::vector<unsigned char>(3 * texels, 128),
                  std::vector<float>(texels, 0.5F)};
  for (std::size_t k = 0; k < unlike.size(); ++k) put(unlike[k], places.corner[k], picture);
  for (std::size_t t = 0; t < surface.size(); ++t) {
    const AtlasChart& chart = atlas.charts[atlas.chart_of[t]];
    const auto [x, y] = places.corner[number[chart.tile]];
    NewUv fresh{surface[t].instance, surface[t].triangle, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 at = atlas.texels_per_repeat * surface[t].uv[k];
      fresh.uv[k] = {(at.x - chart.left + x) / picture.width, 1 - (at.y - chart.top + y) / picture.height};
    }
    uv.push_back(fresh);
  }
  json["atlas"] = {{"width", picture.width},        {"height", picture.height},
                   {"charts", atlas.charts.size()}, {"tiles_computed", atlas.tiles.size()},
                   {"tiles", unlike.size()},        {"texels_per_repeat", atlas.texels_per_repeat}};
  return picture;
}

/// Where the recipe reads nothing of the surface, or no texel is shown by two places: one repeat, or nothing.
std::optional<SurfaceTexels> one_repeat(std::span<const SurfaceTriangle> surface, const SurfaceReading& reading,
                                        int size) {
  SurfaceTexels texels(0, 0, size, size, true);
  for (const SurfaceTriangle& t : surface)
    if (draw(texels, t, size, reading) > 0) return std::nullopt;
  grow(texels, k_gutter);
  // What no surface shows is painted, too, and looks upwards.
  for (std::size_t at = 0; at < texels.count(); ++at)
    if (!texels.covered[at]) texels.covered[at] = 1, texels.normals[3 * at + 1] = 1;
  return texels;
}

/// The tag of a material, with the friction and stiffness of its new surface.
void feel(Material& material, MaterialTag tag, double friction, double factor) {
  const double ratio = tag.dynamic_friction > 0 ? tag.static_friction / tag.dynamic_friction : 1;
  tag.dynamic_friction = friction, tag.static_friction = ratio * friction;
  tag.stiffness *= factor;
  material.extras_json = with_material_tag(material.extras_json, tag);
}

/// Everything that a material's look depends on apart from the scene.
std::string key_of(const Job& job, std::uint32_t index, const std::string& recipe, const ProceduralTexture& texture) {
  std::string key = std::to_string(index) + '\n' + std::to_string(job.config.size) + '\n' +
                    std::to_string(job.config.depth_mm) + '\n' + std::to_string(job.config.sky_rays) + '\n' +
                    std::to_string(texture.depends_on_time() ? job.time : 0) + '\n' + recipe;
  for (const std::string& name : texture.recipes_used()) key += '\n' + name + ' ' + *job.library.find(name);
  return key;
}

/// Paints one material anew.
AgedMaterial paint_material(Job& job, std::uint32_t index, const ProceduralTexture& texture) {
  const Material& before = job.scene.materials[index];
  AgedMaterial aged;
  const std::vector<SurfaceTriangle> surface =
      surface_of(job.scene, job.all, index, before.base_color_texture ? &*before.base_color_texture : nullptr);
  const double mm = mm_per_repeat(surface);
  if (!(mm > 0)) {
    aged.json["skipped"] = "no surface with uv shows it";
    return aged;
  }
  const bool reads_sky = texture.depends_on_sky();
  if (reads_sky && !job.sky) job.sky = sky_of(job.scene, job.all, job.config.sky_rays);
  const SurfaceReading reading{texture.dirt_directions(), texture.depends_on_position(), reads_sky};
  const OwnColour own(job.scene, before);
  Felt felt;
  Painted picture;
  double scale = job.config.size;
  const std::optional<SurfaceTexels> plain = one_repeat(surface, reading, job.config.size);
  if (plain) {
    const std::vector<float> sky = reads_sky ? sky_texels(*plain, *job.sky) : std::vector<float>();
    picture = paint(texture, reading, *plain, sky, own, scale, 1, felt);
  } else {
    const SurfaceAtlas atlas = cut_surface(surface, job.config.size, reading, reads_sky ? &*job.sky : nullptr);
    scale = atlas.texels_per_repeat;
    picture = paint_atlas(atlas, surface, texture, reading, own, felt, aged.uv, aged.json);
  }
  const double pitch = mm / scale;
  HeightMap relief{picture.width, picture.height, std::move(picture.bump), pitch, pitch, plain.has_value()};
  for (float& h : relief.mm) h *= static_cast<float>(job.config.depth_mm);
  aged.color_png = encode_png({picture.width, picture.height, std::move(picture.rgb)});
  aged.normal_png = encode_png(normal_map(relief));
  aged.friction = felt.friction / felt.texels, aged.stiffness = felt.stiffness / felt.texels;
  aged.json["depends_on"] = {
      {"normal", texture.depends_on_normal()}, {"position", texture.depends_on_position()}, {"sky", reads_sky}};
  aged.json["uses"] = texture.recipes_used();
  aged.json["mm_per_texel"] = pitch;
  aged.json["friction"] = aged.friction;
  aged.json["stiffness"] = aged.stiffness;
  return aged;
}

/// Puts what was painted onto the material.
void apply(const AgedMaterial& aged, const std::optional<MaterialTag>& tag, Material& material, Pictures& pictures) {
  TextureReference place;
  if (aged.uv.empty() && material.base_color_texture) place = *material.base_color_texture;
  for (auto* reference : {&material.base_color_texture, &material.normal_texture}) {
    const bool colour = reference == &material.base_color_texture;
    *reference =
        pictures.add((colour ? "color." : "normal.") + material.name, colour ? aged.color_png : aged.normal_png);
    (*reference)->transform = place.transform, (*reference)->tex_coord = place.tex_coord;
  }
  material.base_color = {1, 1, 1, material.base_color[3]};
  if (tag) feel(material, *tag, aged.friction, aged.stiffness);
}

/// Ages one material. @returns what to tell of it.
Json age(WeatherResult& result, std::uint32_t index, Job& job, WeatherCache& cache, Pictures& pictures,
         std::vector<NewUv>& uv, std::vector<std::uint32_t>& with_atlas) {
  const Material& before = job.scene.materials[index];
  std::vector<HapticWarning> warnings;
  const std::optional<MaterialTag> tag = material_tag_of_extras(before.extras_json, warnings);
  const std::string recipe = layered_recipe(job.config, before.name, tag ? tag->dynamic_friction : k_common_friction);
  Json json{{"name", before.name}, {"recipe", recipe}};
  if (recipe.empty()) return json;
  CompileOptions options = recipe_options(job.config.folder);
  options.time = job.time, options.source = "weather, material '" + before.name + "'";
  const ProceduralTexture texture = compile_texture(recipe, job.library, options);
  const std::string key = key_of(job, index, recipe, texture);
  auto it = cache.find(key);
  if (it == cache.end()) {
    it = cache.emplace(key, paint_material(job, index, texture)).first;
    ++result.painted;
  }
  const AgedMaterial& aged = it->second;
  json.update(aged.json);
  if (aged.color_png.empty()) return json;
  apply(aged, tag, result.scene.materials[index], pictures);
  uv.insert(uv.end(), aged.uv.begin(), aged.uv.end());
  if (!aged.uv.empty()) with_atlas.push_back(index);
  return json;
}

}  // namespace

WeatherResult weather(const Scene& scene, const WeatherConfig& config, double time, WeatherCache& cache) {
  RecipeLibrary library = RecipeLibrary::builtin();
  for (const std::string& file : config.libraries) library.read_file(config.folder / file);
  WeatherResult result;
  result.scene = scene;
  Pictures pictures(result);
  Job job{scene, config, library, time, instances(scene), {}};
  std::vector<NewUv> uv;
  std::vector<std::uint32_t> with_atlas;
  for (std::uint32_t m = 0; m < scene.materials.size(); ++m)
    result.materials.push_back(age(result, m, job, cache, pictures, uv, with_atlas));
  if (!with_atlas.empty()) set_atlas_uv(result.scene, job.all, std::move(uv), with_atlas);
  return result;
}

WeatherResult weather(const Scene& scene, const WeatherConfig& config, double time) {
  WeatherCache cache;
  return weather(scene, config, time, cache);
}

}  // namespace papilla::app
