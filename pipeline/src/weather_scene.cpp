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
#include <span>
#include <utility>

#include "papilla/core/error.hpp"
#include "papilla/haptic/material_tag.hpp"
#include "papilla/haptic/sha256.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/quantity_maps.hpp"
#include "papilla/pipeline/recipe_source.hpp"
#include "papilla/procedural/texture.hpp"
#include "papilla/texture/normal_map.hpp"
#include "papilla/texture/roughness.hpp"
#include "surface/atlas_uv.hpp"
#include "surface/painted_surface.hpp"
#include "surface/surface_atlas.hpp"
#include "surface/surface_texels.hpp"
#include "weather/layered_materials.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

/// A material as it was painted.
struct PaintedMaterial {
  std::optional<PaintedSurface> surface;  ///< Kept behind finish() for looks only.
  std::shared_ptr<const WeatheredLook> look;
  bool is_finished = false;  ///< What a scene holds of it is made.
  double pitch_mm = 0;
  std::vector<std::byte> color_png, normal_png, shine_png;  ///< Empty where there is none.
  double roughness = 1, metallic = 1;                       ///< Factors.
  std::vector<NewUv> uv;                                    ///< Empty when it keeps its coordinates.
  std::optional<HeightTag> height;                          ///< Of tagged materials.
  bool new_relief = false, means_shine = false, has_holes = false;
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

/// Friction, stiffness and damping of a new surface.
void set_haptic_constants(MaterialTag& tag, const WeatheredMaterial& worn) {
  const double ratio = tag.dynamic_friction > 0 ? tag.static_friction / tag.dynamic_friction : 1;
  tag.dynamic_friction = worn.friction, tag.static_friction = ratio * worn.friction;
  tag.stiffness *= worn.stiffness;
  tag.damping *= worn.damping;
}

/// Gives a tagged material the maps of its layers, on the coordinates of what was painted. A relief that stays on other
/// ones leaves no place for them: they become constants.
void assign_maps(Material& material, MapsTag maps, std::vector<std::string>& losses) {
  if (!material.haptic) return;
  const TextureReference& place = *material.base_color_texture;
  if (material.haptic->height && material.haptic->height->tex_coord != place.tex_coord) {
    losses.push_back(
        fmt::format("material '{}': where its layers change friction, stiffness and damping, which are means "
                    "over the surface, for its relief lies on other coordinates",
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
  std::string key = fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}\n{}", index, job.config.stable_layout, job.config.size,
                                job.config.atlas_side(), job.config.depth_mm, job.config.sky_rays,
                                texture.depends_on_time() ? job.time : 0, recipe);
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
  const auto surface = std::make_shared<MaterialSurface>(
      lay_out(job.scene, job.all, index, own_place(job.scene.materials[index]), job.config.size,
              job.config.atlas_side(), reading, [&]() -> const SkyView& {
                if (!job.sky) job.sky = sky_of(job.scene, job.all, job.config.sky_rays);
                return *job.sky;
              }));
  if (surface->mm_per_repeat > 0) add_own_surface(job.scene, job.all, index, job.config.size, *surface);
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
  const SurfaceReading reading = reading_of(texture);
  std::optional<StainField>& stains = job.cache.stains;
  if (texture.depends_on_flow() && !stains) stains = stains_of(job.scene, job.all);
  const auto surface = surface_for(job, index, reading);
  report_material(job, k_laid_out);
  if (!(surface->mm_per_repeat > 0)) {
    report.skipped = "no surface with uv shows it";
    return material;
  }
  const ProceduralTexture tiling = surface->repeat && surface->leaves_the_repeat() ? compiled(true) : texture;
  PaintedSurface& painted = material.surface.emplace(paint_surface(
      *surface,
      {.texture = texture,
       .tiling = tiling,
       .reading = reading,
       .own = &*surface->own,
       .stains = texture.depends_on_flow() ? &*stains : nullptr,
       .depth_mm = job.config.depth_mm,
       .friction = tag ? tag->dynamic_friction : k_common_friction,
       .share_equal = !job.config.stable_layout,
       .progress = [&](double done) { report_material(job, k_laid_out + done * (k_painted - k_laid_out)); }}));
  material.uv = std::exchange(painted.uv, {});
  material.pitch_mm = surface->mm_per_repeat / painted.texels_per_repeat;
  material.new_relief = !tag || !tag->height || surface->own->has_relief();
  material.means_shine = surface->own->means_shine();
  material.has_holes = !painted.ranges.alpha.is_constant();
  if (!surface->repeat)
    report.atlas = {painted.picture.width,       painted.picture.height, surface->atlas.charts.size(),
                    surface->atlas.tiles.size(), painted.distinct_tiles, painted.texels_per_repeat};
  const SurfaceRanges& ranges = painted.ranges;
  report.friction = ranges.friction.mean(), report.stiffness = ranges.stiffness.mean();
  report.damping = ranges.damping.mean(), report.alpha = ranges.alpha.mean();
  report.roughness = ranges.roughness.mean(), report.metallic = ranges.metallic.mean();
  report.keeps_relief = surface->keeps_relief;
  report.depends_on_normal = texture.depends_on_normal(), report.depends_on_position = reading.position;
  report.depends_on_sky = reading.sky, report.depends_on_neighbours = texture.depends_on_neighbours();
  report.uses = texture.recipes_used();
  report.own_relief = surface->own->has_relief();
  report.mm_per_texel = material.pitch_mm;
  return material;
}

/// The relief that was painted: a height of 1/2 is the surface as it was.
HeightMap relief_of(const PaintedMaterial& material, double depth_mm) {
  const SurfacePicture& picture = material.surface->picture;
  HeightMap relief{picture.width,     picture.height,    Values<float>(picture.bump.begin(), picture.bump.end()),
                   material.pitch_mm, material.pitch_mm, material.surface->repeats};
  for (float& h : relief.mm) h = (h - 0.5F) * static_cast<float>(depth_mm);
  return relief;
}

/// Makes of a painted surface the pictures and maps that a scene holds.
void finish(PaintedMaterial& material, const std::optional<MaterialTag>& tag, const WeatherConfig& config) {
  if (material.is_finished || !material.surface) return;
  material.is_finished = true;
  SurfacePicture& picture = material.surface->picture;
  if (!material.report.keeps_relief) {
    const HeightMap relief = relief_of(material, config.depth_mm);
    if (tag && material.new_relief) {
      const EncodedHeight encoded = encode_height_png16(relief);
      material.height = make_height_tag(relief, {.png = encoded.png,
                                                 .scale_mm = encoded.scale_mm,
                                                 .offset_mm = encoded.offset_mm,
                                                 .rms_mm = rms_height_mm(relief)});
    }
    material.normal_png = encode_png(normal_map(relief));
  }
  if (tag) {
    QuantityMaps maps{
        picture.width, picture.height, material.pitch_mm, material.pitch_mm, material.surface->repeats, {}};
    maps.maps = {{Quantity::stiffness, adopted_values(std::move(picture.stiffness))},
                 {Quantity::dynamic_friction, adopted_values(std::move(picture.friction))},
                 {Quantity::damping, adopted_values(std::move(picture.damping))}};
    for (float& v : maps.maps[0].values) v *= static_cast<float>(tag->stiffness);
    for (float& v : maps.maps[2].values) v *= static_cast<float>(tag->damping);
    material.report.maps = encode_quantity_maps(std::move(maps));
  }
  const Shine shine = shine_of(*material.surface);
  material.roughness = shine.roughness, material.metallic = shine.metallic;
  if (shine.picture) material.shine_png = encode_png(*shine.picture);
  material.color_png = encode_color(*material.surface);
  if (!config.stable_layout) material.surface.reset();
}

/// What is seen through: holes in an opaque material are cut out, as those of a mask; what is blended stays so.
void set_alpha(Material& material, const PaintedMaterial& painted) {
  material.base_color = {1, 1, 1, painted.has_holes ? 1 : painted.report.alpha};
  if (painted.has_holes && material.alpha_mode == "OPAQUE") material.alpha_mode = "MASK", material.alpha_cutoff = 0.5;
}

/// Gives the material the maps that were painted.
void apply(const PaintedMaterial& painted, Material& material, Pictures& pictures, std::vector<std::string>& losses) {
  TextureReference place;
  if (const TextureReference* own = own_place(material); painted.uv.empty() && own) place = *own;
  const auto put = [&](std::optional<TextureReference>& reference, const char* prefix,
                       const std::vector<std::byte>& png) {
    reference.reset();
    if (png.empty()) return;
    reference = pictures.add(prefix + material.name, png);
    reference->transform = place.transform, reference->tex_coord = place.tex_coord;
  };
  put(material.base_color_texture, "color.", painted.color_png);
  if (!painted.report.keeps_relief) put(material.normal_texture, "normal.", painted.normal_png);
  put(material.metallic_roughness_texture, "metallic_roughness.", painted.shine_png);
  material.roughness = painted.roughness, material.metallic = painted.metallic;
  if (painted.means_shine)
    losses.push_back(
        fmt::format("material '{}': its metallic-roughness picture, which lies on other coordinates than "
                    "its colour; its layers lie over the mean",
                    material.name));
  set_alpha(material, painted);
  if (material.haptic && material.haptic->maps) {
    losses.push_back(
        fmt::format("material '{}': its own maps of stiffness, friction and damping, over which its "
                    "layers lie as if they were constant",
                    material.name));
    material.haptic->maps.reset();
  }
  if (material.haptic) set_haptic_constants(*material.haptic, painted.report);
}

/// What a weathered material gets for the hand.
struct FeltMaps {
  std::optional<HeightTag> height;
  std::optional<MapsTag> maps;
};

/// A material as it is painted, from the cache or anew; `painted` counts those.
/// @return its key; without a layer nothing is painted, and there is no material.
std::pair<std::string, PaintedMaterial*> painted_material(std::uint32_t index, Job& job, int& painted) {
  const Material& before = job.scene.materials[index];
  const std::optional<MaterialTag>& tag = before.haptic;
  const std::string recipe =
      layered_recipe(job.config, job.layers[index], tag ? tag->dynamic_friction : k_common_friction);
  if (recipe.empty()) return {};
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
  std::string key = key_of(job, index, recipe, texture, read);
  auto it = job.cache.painted.find(key);
  if (it == job.cache.painted.end()) {
    it = job.cache.painted.emplace(key, paint_material(job, index, tag, texture, compiled)).first;
    it->second.report.name = before.name, it->second.report.recipe = recipe;
    ++painted;
  }
  return {std::move(key), &it->second};
}

/// Weathers one material. @return what is reported of it.
WeatheredMaterial weather_material(WeatherResult& result, std::uint32_t index, Job& job, Pictures& pictures,
                                   std::vector<NewUv>& uv, std::vector<AtlasMaterial>& with_atlas,
                                   std::vector<FeltMaps>& felt) {
  const Material& before = job.scene.materials[index];
  WeatheredMaterial report;
  report.name = before.name;
  PaintedMaterial* const found = painted_material(index, job, result.painted).second;
  if (!found) return report;
  PaintedMaterial& painted = *found;
  finish(painted, before.haptic, job.config);
  report = painted.report;
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

/// How a material is seen that was painted and keeps its pixels.
std::shared_ptr<const WeatheredLook> look_of(PaintedMaterial& painted, const Material& before, double depth_mm) {
  if (painted.look) return painted.look;
  const SurfacePicture& picture = painted.surface->picture;
  WeatheredLook look;
  look.width = picture.width, look.height = picture.height;
  look.color = picture.rgba;
  if (!painted.report.keeps_relief) look.normal = with_alpha(normal_map(relief_of(painted, depth_mm)));
  const Shine shine = shine_of(*painted.surface);
  look.roughness = shine.roughness, look.metallic = shine.metallic;
  if (shine.picture) look.shine = with_alpha(*shine.picture);
  Material after = before;
  set_alpha(after, painted);
  look.opacity = after.base_color[3], look.alpha_mode = after.alpha_mode;
  painted.look = std::make_shared<const WeatheredLook>(std::move(look));
  return painted.look;
}

/// What a material's coordinates and pictures are laid out by.
std::string layout_of(const PaintedMaterial* painted) {
  if (!painted) return "-";
  std::string text =
      fmt::format("+{} {} {} ", painted->look->width, painted->look->height, painted->report.keeps_relief);
  for (const NewUv& uv : painted->uv)
    for (const Vec2& place : uv.uv) text += fmt::format("{} {} ", place.x, place.y);
  return text;
}

/// The libraries of the configuration, which are watched even where they can't be read.
RecipeLibrary read_libraries(const WeatherConfig& config, WeatherCache& cache) {
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
  return library;
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
  const RecipeLibrary library = read_libraries(config, cache);
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

WeatherLooks weather_looks(const Scene& scene, const WeatherConfig& config, double time, WeatherCache& cache,
                           const ProgressCallback& progress) {
  if (!config.stable_layout) throw InvalidInput("weather_looks: the layout of the atlases must be stable");
  const RecipeLibrary library = read_libraries(config, cache);
  const LayeredScene layered = layer_materials(scene, config);
  const std::vector<std::string> problems = problems_of(layered.uses, "layer", "/layers");
  if (config.strict && !problems.empty()) throw InvalidInput(config.source + ": " + problems.front());
  const Scene& before = layered.scene ? *layered.scene : scene;
  WeatherCache::State& state = cache.state();
  state.expect(before);
  WeatherLooks looks;
  Job job{before, config, layered.layers, library, time, state, progress, instances(before), {}};
  std::set<std::string> used;
  for (const std::uint32_t part : state.shown) looks.layout += fmt::format("{} ", part);
  for (std::uint32_t m = 0; m < before.materials.size(); ++m) {
    job.material = m;
    report_material(job, 0);
    auto [key, painted] = painted_material(m, job, looks.painted);
    looks.materials.push_back(
        painted && painted->report.painted() ? look_of(*painted, before.materials[m], config.depth_mm) : nullptr);
    looks.layout += layout_of(looks.materials.back() ? painted : nullptr);
    used.insert(std::move(key));
  }
  looks.layout = sha256_hex(std::as_bytes(std::span(looks.layout)));
  std::erase_if(state.painted, [&](const auto& entry) { return !used.contains(entry.first); });
  return looks;
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
