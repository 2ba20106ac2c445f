// SPDX-License-Identifier: MIT
#include "papilla/pipeline/grain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>

#include "papilla/core/error.hpp"
#include "papilla/core/near_name.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/core/units.hpp"
#include "papilla/haptic/tag_limits.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/height_file.hpp"
#include "papilla/pipeline/recipe_source.hpp"
#include "papilla/procedural/texture.hpp"
#include "papilla/texture/height_from_image.hpp"
#include "papilla/texture/normal_map.hpp"
#include "papilla/texture/resample.hpp"
#include "papilla/texture/roughness.hpp"
#include "papilla/texture/symmetry.hpp"
#include "papilla/texture/texture_class.hpp"
#include "papilla/texture/tiling.hpp"
#include "papilla/texture/wallpaper_group.hpp"

namespace papilla {
namespace {

/// More samples than this a side show and feel like nothing: at 40 mm a repeat they are finer than 0.04 mm.
constexpr int k_most_samples = 1024;
/// Samples a side of a repeat that is computed.
constexpr int k_recipe_samples = 512;
/// Peak to valley of a relief of which nothing is said, as a share of the shorter side of the grain.
constexpr double k_default_depth = 0.01;

/// Width and height of one repeat, from the rule or from the picture's resolution.
void find_size(const MaterialRule& rule, const GreyImage& image, double (&size_mm)[2]) {
  const double pixels[2] = {static_cast<double>(image.width), static_cast<double>(image.height)};
  for (int k = 0; k < 2; ++k) {
    size_mm[k] = rule.size_mm[k] > 0 ? rule.size_mm[k] : pixels[k] * image.pitch_mm;
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

/// The relief of the picture, at most k_most_samples a side, over size_mm.
HeightMap make_relief(const MaterialRule& rule, const GreyImage& image, const Lattice& lattice, Grain& grain) {
  HeightOptions options;
  options.lattice = lattice;
  options.method = height_method(rule.height.method);
  options.pitch_mm = grain.size_mm[0] / image.width;
  options.depth_mm = rule.height.depth_mm.value_or(k_default_depth * std::min(grain.size_mm[0], grain.size_mm[1]));
  HeightResult result = height_from_image(image, options);
  HeightMap relief = std::move(result.map);
  relief.pitch_mm_x = grain.size_mm[0] / relief.width;
  relief.pitch_mm_y = grain.size_mm[1] / relief.height;
  if (relief.width > k_most_samples || relief.height > k_most_samples)
    relief = resample(relief, std::min(relief.width, k_most_samples), std::min(relief.height, k_most_samples));
  for (float& h : relief.mm) h = static_cast<float>(rule.height.scale * static_cast<double>(h));
  grain.height = {.method = std::string(to_string(result.method)),
                  .reason = result.reason,
                  .light = result.light,
                  .light_estimated = result.light_estimated,
                  .stop = result.stop};
  return relief;
}

/// The picture of a material, from a file or computed.
struct Source {
  GreyImage grey;  ///< Of a recipe: the height channel.
  ColorImage color;
  bool recipe = false;
  double friction = 0, stiffness = 1;  ///< Of a recipe: means of the channels.
};

double mean_of(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Source computed_source(const MaterialRule& rule, const RecipeLibrary& library) {
  CompileOptions options = recipe_options(rule.texture.parent_path());
  options.source = "material '" + rule.name + "', texture";
  options.seamless = true;
  options.time = rule.time;
  RenderOptions render;
  render.width = render.height = k_recipe_samples;
  for (const Channel c : {Channel::bump, Channel::color, Channel::friction, Channel::stiffness})
    render.channels |= 1U << static_cast<unsigned>(c);
  RenderedTexture texture = render_texture(compile_texture(rule.recipe, library, options), render);
  Source source;
  source.recipe = true;
  source.friction = mean_of(texture.values[Channel::friction]);
  source.stiffness = mean_of(texture.values[Channel::stiffness]);
  source.color = to_color_image(texture.values[Channel::color], texture.width, texture.height);
  source.grey = {texture.width, texture.height, texture.values[Channel::bump], 0, 32};
  return source;
}

/// A file of that name wins over a recipe of that name.
Source read_source(const MaterialRule& rule, const RecipeLibrary& library) {
  std::error_code error;
  if (!std::filesystem::exists(rule.texture, error) && looks_like_recipe(rule.recipe, library))
    return computed_source(rule, library);
  try {
    Picture picture = read_picture(rule.texture, k_height_bytes_per_pixel + 3);
    return {std::move(picture.grey), std::move(picture.color)};
  } catch (const IoError& unread) {
    std::vector<std::string_view> recipes;
    for (const auto& [name, recipe] : library.recipes()) recipes.push_back(name);
    throw IoError("material '" + rule.name + "', texture: " + unread.what() + did_you_mean(rule.recipe, recipes));
  } catch (const InvalidInput& unread) {
    throw InvalidInput("material '" + rule.name + "', texture: " + unread.what());
  }
}

/// A recipe's height is a share of the depth: nothing has to be guessed from shading.
HeightMap computed_relief(const MaterialRule& rule, const Source& source, Grain& grain) {
  const double depth = rule.height.depth_mm.value_or(k_default_depth * std::min(grain.size_mm[0], grain.size_mm[1]));
  HeightMap relief{source.grey.width,
                   source.grey.height,
                   source.grey.pixels,
                   grain.size_mm[0] / source.grey.width,
                   grain.size_mm[1] / source.grey.height,
                   true};
  for (float& h : relief.mm) h *= static_cast<float>(depth * rule.height.scale);
  grain.height = {.method = "recipe", .reason = "the height channel of the recipe"};
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
  height.max_slope = rule.height.max_slope.value_or(default_max_slope(constants.static_friction));
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

void describe_relief(Grain& grain) {
  grain.roughness = measure_roughness(grain.relief);
  RoughnessTag tag;
  tag.rms_height_m = grain.roughness.rms_mm * k_metres_per_mm;
  tag.wavelength_range_m = {grain.roughness.shortest_wavelength_mm * k_metres_per_mm,
                            grain.roughness.longest_wavelength_mm * k_metres_per_mm};
  if (grain.roughness.fractal) tag.fractal_dimension = std::clamp(grain.roughness.fractal->dimension, 2.0, 3.0);
  grain.tag.roughness = tag;
}

/// Class, lattice and look of the picture. @return its lattice, found or not.
Lattice analyze(const MaterialRule& rule, const Source& source, Grain& grain) {
  const GreyImage& image = source.grey;
  const SymmetryAnalysis symmetry = analyze_symmetry(image);
  grain.kind = classify(image, symmetry.explained_variance(), symmetry.lattice.stripes);
  grain.tiles = measure_tiling(image).tiles;
  grain.monochrome = is_monochrome(source.color);
  if (rule.show == "picture" || (rule.show == "auto" && !grain.monochrome))
    grain.picture = png("grain." + rule.name, encode_png(source.color));
  if (!symmetry.lattice.found) return symmetry.lattice;
  const Vec2 mm_per_px{grain.size_mm[0] / image.width, grain.size_mm[1] / image.height};
  GrainLattice lattice;
  SymmetryTag tag;
  for (std::size_t k = 0; k < 2; ++k) {
    const Vec2 px = symmetry.lattice.vectors_px[k];
    lattice.period_mm[k] = {px.x * mm_per_px.x, px.y * mm_per_px.y};
    tag.period_m[k] = k_metres_per_mm * lattice.period_mm[k];
  }
  tag.group = lattice.group = to_string(find_wallpaper_group(symmetry).group);
  grain.lattice = lattice;
  grain.tag.symmetry = tag;
  return symmetry.lattice;
}

}  // namespace

double default_max_slope(double static_friction) {
  constexpr double k_share = 1.0 / 3, k_most = 1;
  return static_friction > 0 ? std::min(k_most, k_share / static_friction) : k_most;
}

Grain make_grain(const MaterialRule& rule, const RecipeLibrary& library) {
  Grain grain;
  const Stopwatch analyze_clock;
  Source source = read_source(rule, library);
  find_size(rule, source.grey, grain.size_mm);
  const Lattice lattice = analyze(rule, source, grain);
  grain.source = source.recipe ? rule.recipe : rule.texture.string();
  if (source.recipe) {
    grain.tag.static_friction = grain.tag.dynamic_friction = source.friction;
    grain.stiffness_factor = source.stiffness;
  }
  grain.photograph = std::move(source.color);
  grain.analyze_seconds = analyze_clock.seconds();

  const Stopwatch height_clock;
  grain.relief = source.recipe ? computed_relief(rule, source, grain) : make_relief(rule, source.grey, lattice, grain);
  limit_heights(rule, grain);
  limit_slopes(rule, grain);
  describe_relief(grain);
  const EncodedHeight encoded = encode_height_png16(grain.relief);
  grain.tag.height = make_height_tag(grain.relief, {.png = encoded.png,
                                                    .scale_mm = encoded.scale_mm,
                                                    .offset_mm = encoded.offset_mm,
                                                    .rms_mm = rms_height_mm(grain.relief)});
  grain.tag.height->metres_per_uv = {grain.size_mm[0] * k_metres_per_mm, grain.size_mm[1] * k_metres_per_mm};
  grain.height_seconds = height_clock.seconds();

  const Stopwatch normal_clock;
  grain.normal_png = png("normal." + rule.name, encode_png(normal_map(grain.relief)));
  grain.normal_map_seconds = normal_clock.seconds();

  grain.tag.provenance = {std::string("papilla ") + version(), grain.height.method, "analyze height normal_map tag"};
  grain.height_png = png("height." + rule.name, encoded.png);
  return grain;
}

void apply_constants(const MaterialRule& rule, MaterialTag& tag, double stiffness_factor) {
  tag.stiffness = stiffness_factor * rule.stiffness.value_or(tag.stiffness);
  if (rule.damping) tag.damping = *rule.damping;
  tag.static_friction = rule.static_friction.value_or(rule.dynamic_friction.value_or(tag.static_friction));
  tag.dynamic_friction = rule.dynamic_friction.value_or(rule.static_friction.value_or(tag.dynamic_friction));
  if (rule.stribeck_velocity) tag.stribeck_velocity = *rule.stribeck_velocity;
  if (rule.friction_model) tag.friction_model = *rule.friction_model;
  if (rule.force_shading) tag.force_shading = *rule.force_shading;
}

UvTransform transform_to_repeats(const Grain& grain, double mm_per_unit) {
  UvTransform transform;
  transform.scale = {mm_per_unit / grain.size_mm[0], mm_per_unit / grain.size_mm[1]};
  return transform;
}

MaterialTag surface_tag(const MaterialRule& rule, const Grain* grain, double kept_mm_per_unit) {
  MaterialTag tag = grain != nullptr ? grain->tag : MaterialTag();
  if (grain != nullptr && kept_mm_per_unit > 0) {
    const double metres = kept_mm_per_unit * k_metres_per_mm;
    tag.height->uv_transform.scale = transform_to_repeats(*grain, kept_mm_per_unit).scale;
    tag.height->metres_per_uv = {metres, metres};
  }
  apply_constants(rule, tag, grain != nullptr ? grain->stiffness_factor : 1);
  return tag;
}

}  // namespace papilla
