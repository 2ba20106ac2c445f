// SPDX-License-Identifier: MIT
#include "papilla/pipeline/grain.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "grain_source.hpp"
#include "papilla/cache/stage_cache.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/core/units.hpp"
#include "papilla/haptic/material_tag_stream.hpp"
#include "papilla/haptic/tag_limits.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/height_file.hpp"
#include "papilla/pipeline/quantity_maps.hpp"
#include "papilla/pipeline/stereo_file.hpp"
#include "papilla/procedural/texture.hpp"
#include "papilla/texture/height_from_image.hpp"
#include "papilla/texture/normal_map.hpp"
#include "papilla/texture/picture_relief.hpp"
#include "papilla/texture/resample.hpp"
#include "papilla/texture/roughness.hpp"
#include "papilla/texture/texture_class.hpp"
#include "papilla/texture/texture_reading.hpp"
#include "papilla/texture/tiling.hpp"
#include "papilla/texture/wallpaper_group.hpp"
#include "remembered_plan.hpp"
#include "solid_grain.hpp"
#include "surface/painted_surface.hpp"

namespace papilla {

// Arrays of C among the fields.
template <>
inline constexpr std::size_t k_field_count<MapRule> = 3;
template <>
inline constexpr std::size_t k_field_count<MaterialRule> = 26;
template <>
inline constexpr std::size_t k_field_count<Grain> = 26;

namespace {

/// For read_texture() and the dimension of the relief, on one slow core.
constexpr double k_seconds_to_read_a_pixel = 8e-6;

/// Width and height of one repeat, from the rule or from the picture's resolution.
void find_size(const MaterialRule& rule, const GreyImage& image, double (&size_mm)[2]) {
  const double pixels[2] = {static_cast<double>(image.width), static_cast<double>(image.height)};
  for (int k = 0; k < 2; ++k) {
    const double pitch_mm = rule.height.pitch_mm > 0 ? rule.height.pitch_mm : image.pitch_mm;
    size_mm[k] = rule.size_mm[k] > 0 ? rule.size_mm[k] : pixels[k] * pitch_mm;
    if (!(size_mm[k] > 0))
      throw InvalidInput("material '" + rule.name + "': " + rule.texture.string() +
                         " has no resolution; size_mm must say how many millimetres it shows");
  }
}

EncodedImage png(std::string name, std::vector<std::byte> bytes) {
  EncodedImage image;
  image.name = std::move(name);
  image.mime_type = "image/png";
  image.bytes = std::move(bytes);
  return image;
}

bool measures_pitch(const MaterialRule& rule) {
  using Kind = HeightReference::Kind;
  return std::any_of(rule.height.references.begin(), rule.height.references.end(),
                     [](const HeightReference& r) { return r.kind == Kind::ruler || r.kind == Kind::grid; });
}

/// Errors of the rule's photographs name the place.
template <class Work>
auto about_images(const MaterialRule& rule, const Work& work) try {
  return work();
} catch (const IoError& error) {
  throw IoError("material '" + rule.name + "', height.images: " + error.what());
} catch (const InvalidInput& error) {
  throw InvalidInput("material '" + rule.name + "', height.images: " + error.what());
}

/// The relief of the rule's photographs, and the size that a ruler in them says.
StereoFiles make_stereo(const MaterialRule& rule, double (&size_mm)[2], std::vector<std::string>& warnings) {
  const int width = width_of_picture_files(rule.height.images);
  StereoFileOptions options{.files = {}, .lights = rule.height.lights, .references = rule.height.references};
  options.files.height = rule.height.relief.height;
  options.files.height.pitch_mm = rule.height.pitch_mm > 0 ? rule.height.pitch_mm : rule.size_mm[0] / width;
  options.is_depth_given = rule.height.depth_mm.has_value();
  options.files.height.depth_mm = rule.height.depth_mm.value_or(0);
  StereoFiles made = relief_of_picture_files(rule.height.images, options);
  const HeightMap& map = made.files.result.map;
  if (!(map.pitch_mm_x > 0))
    throw InvalidInput("no resolution; size_mm, height.pitch or a ruler must say how many millimetres they show");
  if (!measures_pitch(rule)) return made;
  const double measured[2] = {map.pitch_mm_x * map.width, map.pitch_mm_y * map.height};
  constexpr double k_same = 0.02;
  for (int k = 0; k < 2; ++k) {
    if (rule.size_mm[k] > 0 && std::abs(measured[k] - rule.size_mm[k]) > k_same * measured[k])
      warnings.push_back(fmt::format("material '{}': size_mm/{}: {:.4g} mm are {:.4g} mm by the ruler in height.images",
                                     rule.name, k, rule.size_mm[k], measured[k]));
    size_mm[k] = measured[k];
  }
  return made;
}

/// What is done with the photographs of one place.
AnalysisPlan stereo_plan(const HeightRule& rule) {
  return {{"registration", true, "photographs of one place may be moved by pixels"},
          {"photometric_stereo", true,
           fmt::format("{} photographs under different light, lights {}", rule.images.size(),
                       rule.lights.sphere               ? "by a ball"
                       : rule.lights.directions.empty() ? "unknown"
                                                        : "given")}};
}

/// What the class's plan is carried out with.
PictureReliefOptions relief_options(const MaterialRule& rule, const SourcePicture& source, const Grain& grain) {
  PictureReliefOptions options = rule.height.relief;
  options.height.transfer = source.transfer;
  options.height.pitch_mm = grain.size_mm[0] / source.grey.width;
  options.height.depth_mm = depth_mm_of(rule, grain.size_mm);
  options.seen = grain.picture.has_value();
  return options;
}

/// Roughness laid over a relief must leave it as gentle as the friction asks: twice its root mean square slope is what
/// it adds to the relief's, so that takes at most half of what there is.
void limit_roughness(const MaterialRule& rule, double max_slope, Grain& grain) {
  constexpr double k_peaks = 2, k_most_share = 0.5;
  if (!grain.height.overlay) return;
  RoughnessModel& overlay = *grain.height.overlay;
  const double most = k_most_share * max_slope / k_peaks;
  if (overlay.rms_slope > most) {
    const double share = most / overlay.rms_slope;
    grain.warnings.push_back(
        fmt::format("material '{}': height: its roughness of rms {:.3g} mm is steeper than the friction lets go; "
                    "reduced to {:.3g} mm",
                    rule.name, overlay.rms_mm, share * overlay.rms_mm));
    overlay.rms_mm *= share;
    overlay.rms_slope = most;
  }
  grain.height.max_slope = max_slope - k_peaks * overlay.rms_slope;
}

/// What the rule makes of a relief, at most k_most_samples a side.
HeightMap fitted(const MaterialRule& rule, HeightMap relief) {
  if (rule.height.opposite) relief = opposite_relief(relief);
  if (relief.width > k_most_samples || relief.height > k_most_samples)
    relief = resample(relief, std::min(relief.width, k_most_samples), std::min(relief.height, k_most_samples));
  for (float& h : relief.mm) h = static_cast<float>(rule.height.scale * static_cast<double>(h));
  return relief;
}

/// The relief of several photographs over the grain's size.
HeightMap several_relief(const MaterialRule& rule, StereoFiles made, Grain& grain) {
  HeightMap relief = std::exchange(made.files.result.map, {});
  relief.pitch_mm_x = grain.size_mm[0] / relief.width;
  relief.pitch_mm_y = grain.size_mm[1] / relief.height;
  grain.height = {.method = std::string(to_string(made.files.result.method)),
                  .reason = made.files.result.reason,
                  .light_estimated = made.stereo.lights_estimated,
                  .stop = made.stereo.stop};
  grain.plan = stereo_plan(rule.height);
  made.stereo.confidence = {};
  for (const auto& image : rule.height.images) grain.height.photographs.push_back(image.string());
  grain.height.stereo = std::move(made);
  return fitted(rule, std::move(relief));
}

/// The relief of the picture over the grain's size, which becomes that of the relief.
HeightMap make_relief(const MaterialRule& rule, const SourcePicture& source, const TextureReading& reading,
                      Grain& grain) {
  const GreyImage& image = source.grey;
  PictureRelief made = relief_of_picture(image, reading, relief_options(rule, source, grain));
  HeightMap relief = std::move(made.height.map);
  relief.pitch_mm_x = grain.size_mm[0] / image.width;
  relief.pitch_mm_y = grain.size_mm[1] / image.height;
  grain.size_mm[0] = relief.pitch_mm_x * relief.width;
  grain.size_mm[1] = relief.pitch_mm_y * relief.height;
  relief = fitted(rule, std::move(relief));
  grain.height = {.method = made.like ? "synthesis" : std::string(to_string(made.height.method)),
                  .reason = made.height.reason,
                  .light = made.like || made.height.method == HeightMethod::intensity
                               ? std::nullopt
                               : std::optional(made.height.light),
                  .light_estimated = made.height.light_estimated,
                  .stop = made.height.stop,
                  .overlay = made.roughness};
  if (grain.height.overlay) {
    grain.height.overlay->rms_mm *= rule.height.scale;
    grain.height.overlay->rms_slope *= rule.height.scale;
  }
  grain.plan = std::move(made.plan);
  return relief;
}

/// Waves that no hand and device play are left out of a roughness that the rule has, and those longer than the relief.
void add_fine_roughness(const MaterialRule& rule, Grain& grain) {
  if (!rule.fine_roughness || grain.height.overlay) return;
  RoughnessModel whole = *rule.fine_roughness;
  whole.longest_mm = std::min({whole.longest_mm, grain.size_mm[0], grain.size_mm[1]});
  if (!(whole.shortest_mm < whole.longest_mm)) return;
  grain.height.overlay =
      roughness_above(whole, shortest_playable_wavelength_mm(k_hand_speed_mm_per_s, k_device_rate_hz));
}

/// The maps of the tag. @param size_mm  what the texture shows: the relief may be a tile of it.
void add_maps(const MaterialRule& rule, QuantityMaps maps, const double (&size_mm)[2], Grain& grain) {
  if (maps.maps.empty()) return;
  maps.pitch_mm_x = size_mm[0] / maps.width;
  maps.pitch_mm_y = size_mm[1] / maps.height;
  grain.tag.maps = encode_quantity_maps(std::move(maps));
  MaterialTag constants = grain.tag;
  apply_constants(rule, constants, grain.stiffness_factor, grain.damping_factor);
  for (const Quantity lost : scale_by_constants(grain.tag.maps, constants))
    if (rule.maps.contains(lost))
      grain.warnings.push_back(fmt::format("material '{}': {}: multiplies a constant that is 0, and is left out",
                                           rule.name, key_of_map(lost)));
  if (grain.tag.maps)
    grain.tag.maps->uv_transform.scale = {grain.size_mm[0] / size_mm[0], grain.size_mm[1] / size_mm[1]};
}

/// A recipe has its own height.
void require_picture(const MaterialRule& rule, const SourcePicture& source) {
  if (source.computed)
    throw InvalidInput("material '" + rule.name +
                       "', height.images: the texture is a recipe, which has its own height");
}

/// A recipe's height is a share of the depth: nothing has to be guessed from shading.
/// @param depth  of a height of 1, mm.
HeightMap computed_relief(const MaterialRule& rule, const SourcePicture& source, double depth, Grain& grain) {
  HeightMap relief{source.grey.width,
                   source.grey.height,
                   source.grey.pixels,
                   grain.size_mm[0] / source.grey.width,
                   grain.size_mm[1] / source.grey.height,
                   !source.maps || source.maps->periodic};
  for (float& h : relief.mm) h *= static_cast<float>(depth * rule.height.scale);
  grain.height = rule.recipe.starts_with(k_grain_prefix)
                     ? GrainHeight{.method = "grain", .reason = "the grain is computed"}
                     : GrainHeight{.method = "recipe", .reason = "the height channel of the recipe"};
  return relief;
}

/// Lowest and highest place of a relief in metres.
std::pair<double, double> range_m(const HeightMap& relief) {
  const auto [low, high] = std::minmax_element(relief.mm.begin(), relief.mm.end());
  return {k_metres_per_mm * static_cast<double>(*low), k_metres_per_mm * static_cast<double>(*high)};
}

/// Keeps the relief within what a tag may have.
void limit_heights(const MaterialRule& rule, Grain& grain) {
  const auto [low, high] = range_m(grain.relief);
  const double shift = relief_shift_m(low, high), share = relief_share(low + shift, high + shift);
  if (shift != 0)
    grain.warnings.push_back(
        fmt::format("material '{}': height: its lowest place is {:.4g} mm off the mesh, more than its relief of {:.4g} "
                    "mm; moved by {:.4g} mm",
                    rule.name, 1e3 * low, 1e3 * (high - low), 1e3 * shift));
  if (share != 1)
    grain.warnings.push_back(
        fmt::format("material '{}': height: {:.4g} mm are beyond the limit of {:.4g} mm; shrunk to {:.4g}", rule.name,
                    1e3 * (high + shift), 1e3 * k_highest_relief_m, 1e3 * share * (high + shift)));
  if (shift == 0 && share == 1) return;
  for (float& h : grain.relief.mm) h = static_cast<float>(share * (static_cast<double>(h) + shift / k_metres_per_mm));
}

double range_mm(const HeightMap& relief) {
  const auto [low, high] = range_m(relief);
  return (high - low) / k_metres_per_mm;
}

/// A relief that lost its peaks may lie farther off the mesh than it is high now, which a tag may not.
void bring_to_mesh(HeightMap& relief) {
  const auto [low, high] = range_m(relief);
  const double shift = relief_shift_m(low, high);
  if (shift == 0) return;
  for (float& h : relief.mm) h = static_cast<float>(static_cast<double>(h) + shift / k_metres_per_mm);
}

/// Limits the slopes to what the rule says, or to what its friction allows, also where the relief meets its repeats.
void limit_slopes(const MaterialRule& rule, Grain& grain) {
  MaterialTag constants = grain.tag;
  apply_constants(rule, constants);
  GrainHeight& height = grain.height;
  height.max_slope = rule.height.max_slope.value_or(default_max_slope(largest_static_friction(constants)));
  limit_roughness(rule, height.max_slope, grain);
  height.unlimited_depth_mm = range_mm(grain.relief);
  const bool periodic = std::exchange(grain.relief.periodic, true);
  height.slopes = limit_slope(grain.relief, {.max_slope = height.max_slope});
  grain.relief = std::exchange(height.slopes.relief, {});
  grain.relief.periodic = periodic;
  bring_to_mesh(grain.relief);
  height.depth_mm = range_mm(grain.relief);
  height.rms_mm = rms_height_mm(grain.relief);
  if (height.slopes.stop == StopReason::iteration_limit)
    grain.warnings.push_back(
        fmt::format("material '{}': height: after {} steps {:.3g} % of the relief is still steeper "
                    "than {:.3g}",
                    rule.name, height.slopes.iterations, 100 * height.slopes.share_after, height.max_slope));
}

void describe_relief(Grain& grain, const RoughnessOptions& options) {
  grain.roughness = measure_roughness(grain.relief, options);
  RoughnessTag tag;
  if (const auto& overlay = grain.height.overlay) {
    tag = {3 - overlay->hurst,
           overlay->rms_mm * k_metres_per_mm,
           {overlay->shortest_mm * k_metres_per_mm, overlay->longest_mm * k_metres_per_mm},
           overlay->anisotropy,
           overlay->direction_rad,
           true};
    grain.tag.roughness = tag;
    return;
  }
  tag.rms_height_m = grain.roughness.rms_mm * k_metres_per_mm;
  tag.wavelength_range_m = {grain.roughness.shortest_wavelength_mm * k_metres_per_mm,
                            grain.roughness.longest_wavelength_mm * k_metres_per_mm};
  if (grain.roughness.fractal) tag.fractal_dimension = grain.roughness.fractal->dimension;
  grain.tag.roughness = tag;
}

/// Brings a relief within its limits, and makes its maps.
/// @param dimension  is looked for. @param name  of the pictures.
void finish_relief(const MaterialRule& rule, bool dimension, const std::string& name, Grain& grain) {
  limit_heights(rule, grain);
  limit_slopes(rule, grain);
  describe_relief(grain, {.dimension = dimension});
  EncodedHeight encoded;
  const Stopwatch normal_clock;
  oneapi::tbb::parallel_invoke([&] { encoded = encode_height_png16(grain.relief); },
                               [&] { grain.normal_png = png("normal." + name, encode_png(normal_map(grain.relief))); });
  grain.normal_map_seconds = normal_clock.seconds();
  grain.tag.height = make_height_tag(grain.relief, {.png = encoded.png,
                                                    .scale_mm = encoded.scale_mm,
                                                    .offset_mm = encoded.offset_mm,
                                                    .rms_mm = rms_height_mm(grain.relief)});
  grain.tag.height->metres_per_uv = {grain.size_mm[0] * k_metres_per_mm, grain.size_mm[1] * k_metres_per_mm};
  grain.tag.provenance = {std::string("papilla ") + version(), grain.height.method, "analyze height normal_map tag"};
  grain.height_png = png("height." + name, encoded.png);
}

/// How the picture looks, and whether it is shown.
void look_at(const MaterialRule& rule, const SourcePicture& source, Grain& grain) {
  grain.tiles = measure_tiling(source.grey).tiles;
  grain.monochrome = is_monochrome(source.color);
  if (shows_picture(rule, grain.monochrome)) grain.picture = png("grain." + rule.name, encode_png(source.color));
}

/// Roughness and metallic of a recipe go with its picture. A test grain has neither channel, and no friction.
void take_shine(const SourcePicture& source, const std::string& name, Grain& grain) {
  if (!grain.picture || !source.friction) return;
  grain.roughness_factor = source.shine.roughness, grain.metallic_factor = source.shine.metallic;
  if (source.shine.picture) grain.shine = png("metallic_roughness." + name, encode_png(*source.shine.picture));
}

/// Class and lattice of the picture.
void describe_picture(const TextureReading& reading, Vec2 mm_per_px, Grain& grain) {
  grain.kind = reading.kind;
  if (!reading.group) return;
  GrainLattice lattice;
  SymmetryTag tag;
  for (std::size_t k = 0; k < 2; ++k) {
    const Vec2 px = reading.symmetry.lattice.vectors_px[k];
    lattice.period_mm[k] = {px.x * mm_per_px.x, px.y * mm_per_px.y};
    tag.period_m[k] = k_metres_per_mm * lattice.period_mm[k];
  }
  tag.group = lattice.group = to_string(reading.group->group);
  grain.lattice = lattice;
  grain.tag.symmetry = tag;
}

/// make_grain() without looking into a cache.
/// @param describes  class, lattice and dimension are looked for also where the relief does not need them.
Grain make_whole_grain(const MaterialRule& rule, const RecipeLibrary& library, const Deadline& deadline,
                       bool describes) {
  Grain grain;
  const Stopwatch analyze_clock;
  SourcePicture source = read_source(rule, library);
  std::optional<StereoFiles> several;
  const Stopwatch stereo_clock;
  if (!rule.height.images.empty()) {
    require_picture(rule, source);
    several = about_images(rule, [&] { return make_stereo(rule, grain.size_mm, grain.warnings); });
    grain.height_seconds = stereo_clock.seconds();
  }
  if (!several || !measures_pitch(rule)) find_size(rule, source.grey, grain.size_mm);
  const double size_mm[2] = {grain.size_mm[0], grain.size_mm[1]};
  grain.photograph_mm = {size_mm[0], size_mm[1]};
  QuantityMaps maps = read_maps(rule, std::move(source.maps), library);
  look_at(rule, source, grain);
  ReadingOptions in_time;
  in_time.roughness = !several && !source.computed;  // Only the relief of a picture is made by it.
  in_time.deadline = deadline.earlier_by(k_seconds_to_read_a_pixel * static_cast<double>(source.grey.pixels.size()));
  const TextureReading reading = describes || !source.computed ? read_texture(source.grey, in_time) : TextureReading{};
  if (reading.stop == StopReason::time_limit)
    grain.warnings.push_back(fmt::format(
        "material '{}': no lattice and no roughness was looked for: the time limit left no time for it", rule.name));
  describe_picture(reading, {grain.size_mm[0] / source.grey.width, grain.size_mm[1] / source.grey.height}, grain);
  grain.source = source.computed ? rule.recipe : rule.texture.string();
  if (source.computed) {
    if (source.friction) grain.tag.static_friction = grain.tag.dynamic_friction = *source.friction;
    grain.stiffness_factor = source.stiffness, grain.damping_factor = source.damping;
    take_shine(source, rule.name, grain);
    grain.solid = source.solid;
  }
  grain.photograph = std::move(source.color);
  grain.analyze_seconds = analyze_clock.seconds() - grain.height_seconds;

  const Stopwatch height_clock;
  grain.relief = several           ? several_relief(rule, std::move(*several), grain)
                 : source.computed ? computed_relief(rule, source, depth_mm_of(rule, grain.size_mm), grain)
                                   : make_relief(rule, source, reading, grain);
  add_fine_roughness(rule, grain);
  add_maps(rule, std::move(maps), size_mm, grain);
  finish_relief(rule, reading.stop != StopReason::time_limit && (describes || !source.computed), rule.name, grain);
  grain.height_seconds += height_clock.seconds() - grain.normal_map_seconds;
  return grain;
}

}  // namespace

double default_max_slope(double static_friction) {
  constexpr double k_share = 1.0 / 3, k_most = 1;
  return static_friction > 0 ? std::min(k_most, k_share / static_friction) : k_most;
}

GrainPlan plan_grain(const MaterialRule& rule, const RecipeLibrary& library) {
  GrainPlan plan{rule.name, {}, {}};
  try {
    const SourcePicture source = read_source(rule, library);
    read_maps(rule, source.maps, library);
    if (!rule.height.images.empty()) {
      require_picture(rule, source);
      about_images(rule, [&] { return width_of_picture_files(rule.height.images); });
      plan.steps = stereo_plan(rule.height);
      return plan;
    }
    if (source.computed) return plan;
    Grain grain;
    find_size(rule, source.grey, grain.size_mm);
    look_at(rule, source, grain);
    plan.steps = plan_relief(source.grey, read_texture(source.grey), relief_options(rule, source, grain));
  } catch (const Error& error) {
    plan.problem = error.what();
  }
  return plan;
}

Digest grain_key(const MaterialRule& rule, const RecipeLibrary& library) {
  MaterialRule seen = rule;  // How it lies on uv is no matter of a grain.
  seen.phase_mm = {0, 0};
  seen.unwrap = "auto";
  seen.unwrap_options.reset();
  return key_of("grain", seen, picture_digests(seen, library), library.recipes(), library.colours());
}

std::optional<Grain> find_grain(const MaterialRule& rule, const RecipeLibrary& library, const StageCache& cache) {
  return cache.find<Grain>("grain", grain_key(rule, library));
}

Grain make_grain(const MaterialRule& rule, const RecipeLibrary& library, const Deadline& deadline,
                 const StageCache* cache) {
  const auto make = [&] { return make_whole_grain(rule, library, deadline, true); };
  if (cache == nullptr) return make();
  auto [grain, found] = remembered_by(grain_key(rule, library), *cache, "grain", use_until(deadline), make);
  if (found) grain.analyze_seconds = grain.height_seconds = grain.normal_map_seconds = 0;
  return std::move(grain);
}

Grain make_shown_grain(const MaterialRule& rule, const RecipeLibrary& library, const Deadline& deadline,
                       const StageCache* cache) {
  if (cache != nullptr)
    if (std::optional<Grain> known = find_grain(rule, library, *cache)) return *std::move(known);
  return make_whole_grain(rule, library, deadline, false);
}

Grain solid_grain(const MaterialRule& rule, const Grain& tile, PaintedSurface painted, const std::string& name) {
  Grain grain = tile;
  grain.warnings.clear();
  grain.lattice.reset(), grain.tag.symmetry.reset(), grain.tag.maps.reset();
  if (!painted.repeats) {
    grain.size_mm[0] *= painted.picture.width / painted.texels_per_repeat;
    grain.size_mm[1] *= painted.picture.height / painted.texels_per_repeat;
  }
  SourcePicture source = painted_source(rule, std::move(painted));
  QuantityMaps maps = *std::exchange(source.maps, std::nullopt);
  const bool periodic = maps.periodic;
  std::erase_if(maps.maps, [&](const QuantityMap& map) { return rule.maps.contains(map.quantity); });
  grain.tag.static_friction = grain.tag.dynamic_friction = *source.friction;
  grain.stiffness_factor = source.stiffness, grain.damping_factor = source.damping;
  grain.relief = computed_relief(rule, source, depth_mm_of(rule, tile.size_mm), grain);
  grain.relief.periodic = periodic;
  if (grain.picture) grain.picture = png("grain." + name, encode_png(source.color));
  grain.shine.reset();
  take_shine(source, name, grain);
  grain.photograph = std::move(source.color);
  const double size_mm[2] = {grain.size_mm[0], grain.size_mm[1]};
  grain.photograph_mm = {size_mm[0], size_mm[1]};
  add_maps(rule, std::move(maps), size_mm, grain);
  finish_relief(rule, false, name, grain);
  return grain;
}

void apply_constants(const MaterialRule& rule, MaterialTag& tag, double stiffness_factor, double damping_factor) {
  tag.stiffness = stiffness_factor * rule.stiffness.value_or(tag.stiffness);
  tag.damping = damping_factor * rule.damping.value_or(tag.damping);
  tag.static_friction = rule.static_friction.value_or(rule.dynamic_friction.value_or(tag.static_friction));
  tag.dynamic_friction = rule.dynamic_friction.value_or(rule.static_friction.value_or(tag.dynamic_friction));
  if (rule.stribeck_velocity) tag.stribeck_velocity = *rule.stribeck_velocity;
  if (rule.friction_model) tag.friction_model = *rule.friction_model;
  if (rule.force_model) tag.force_model = *rule.force_model;
  if (rule.force_shading) tag.force_shading = *rule.force_shading;
  if (rule.backing) tag.backing = *rule.backing;
}

UvTransform transform_to_repeats(const MaterialRule& rule, const Grain& grain, double mm_per_unit) {
  UvTransform transform;
  // What moves along v, which runs down here, comes from farther down.
  transform.offset = {-rule.phase_mm.x / grain.size_mm[0], rule.phase_mm.y / grain.size_mm[1]};
  transform.scale = {mm_per_unit / grain.size_mm[0], mm_per_unit / grain.size_mm[1]};
  return transform;
}

MaterialTag surface_tag(const MaterialRule& rule, const Grain* grain, double kept_mm_per_unit) {
  MaterialTag tag = grain != nullptr ? grain->tag : MaterialTag();
  if (grain != nullptr && kept_mm_per_unit > 0) {
    const double metres = kept_mm_per_unit * k_metres_per_mm;
    const UvTransform repeats = transform_to_repeats(rule, *grain, kept_mm_per_unit);
    for (PlacedPicture* picture : pictures_of(tag)) {
      auto& [offset, rotation, scale] = picture->uv_transform;
      offset = {offset.x + scale.x * repeats.offset.x, offset.y + scale.y * repeats.offset.y};
      scale = {scale.x * repeats.scale.x, scale.y * repeats.scale.y};
    }
    tag.height->metres_per_uv = {metres, metres};
  }
  apply_constants(rule, tag, grain != nullptr ? grain->stiffness_factor : 1,
                  grain != nullptr ? grain->damping_factor : 1);
  if (grain == nullptr && rule.fine_roughness)
    tag.roughness = RoughnessTag{.fractal_dimension = 3 - rule.fine_roughness->hurst,
                                 .rms_height_m = k_metres_per_mm * rule.fine_roughness->rms_mm,
                                 .wavelength_range_m = {k_metres_per_mm * rule.fine_roughness->shortest_mm,
                                                        k_metres_per_mm * rule.fine_roughness->longest_mm}};
  return tag;
}

}  // namespace papilla
