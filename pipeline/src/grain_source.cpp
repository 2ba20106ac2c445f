// SPDX-License-Identifier: MIT
#include "grain_source.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string_view>
#include <utility>

#include "papilla/cache/stage_key.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/near_name.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/grain.hpp"
#include "papilla/pipeline/recipe_source.hpp"
#include "papilla/texture/grain.hpp"
#include "papilla/texture/resample.hpp"

namespace papilla {
namespace {

/// Samples a side of a repeat that is computed.
constexpr int k_recipe_samples = 512;

/// A channel in multiples of its mean.
QuantityMap over_mean(Quantity quantity, Values<float> values, double mean) {
  for (float& v : values) v = mean > 0 ? static_cast<float>(static_cast<double>(v) / mean) : 1;
  return {quantity, std::move(values)};
}

/// The folder of MATERIALS.json, of which `file` is this folder and the recipe's text, in which a / leads nowhere.
std::filesystem::path folder_of(const std::filesystem::path& file, const std::string& recipe) {
  const std::string& whole = file.native();
  return whole.ends_with(recipe) ? whole.substr(0, whole.size() - recipe.size()) : file.parent_path().string();
}

/// A recipe of MATERIALS.json. @param key  where it stands.
/// @param pictures  gets the digests of the pictures that it reads; may be null.
ProceduralTexture compile_recipe(const MaterialRule& rule, const std::filesystem::path& file, const std::string& recipe,
                                 const std::string& key, const RecipeLibrary& library, bool seamless = true,
                                 std::vector<Digest>* pictures = nullptr) {
  CompileOptions options = recipe_options(folder_of(file, recipe));
  if (pictures != nullptr)
    options.read_picture = [pictures, read = options.read_picture](const std::string& path) {
      RecipePicture picture = read(path);
      pictures->push_back(key_of("recipe picture", picture));
      return picture;
    };
  options.source = "material '" + rule.name + "', " + key;
  options.seamless = seamless;
  options.time = rule.time;
  return compile_texture(recipe, library, options);
}

RenderedTexture render_tile(const ProceduralTexture& texture, unsigned channels) {
  RenderOptions render;
  render.width = render.height = k_recipe_samples;
  render.channels = channels;
  return render_texture(texture, render);
}

SourcePicture computed_source(const MaterialRule& rule, const ProceduralTexture& recipe) {
  SourcePicture source = painted_source(rule, painted_repeat(render_tile(recipe, painted_channels())));
  source.solid = reads_surface(recipe);
  return source;
}

GrainResult make_test_grain(const MaterialRule& rule, const std::string& name, GrainOptions options) {
  options.size_px = k_recipe_samples;
  options.seed = rule.height.relief.height.seed;
  return synthesize_grain(grain_kind(name.substr(k_grain_prefix.size())), options);
}

/// A test grain as heights of [0, 1]; its picture is the lit relief.
SourcePicture synthesized_source(const MaterialRule& rule) {
  const GrainOptions options;
  const GrainResult made = make_test_grain(rule, rule.recipe, options);
  SourcePicture source;
  source.computed = true;
  source.grey = {made.relief.width, made.relief.height, made.relief.mm, 0, 32};
  for (float& h : source.grey.pixels) h /= static_cast<float>(options.height_mm);
  for (const float g : made.picture.pixels)
    source.color.pixels.insert(source.color.pixels.end(), 3,
                               static_cast<unsigned char>(std::lround(255 * std::clamp(g, 0.0F, 1.0F))));
  source.color.width = made.picture.width;
  source.color.height = made.picture.height;
  return source;
}

/// The grey values of a map's picture or recipe.
HeightMap read_map(const MaterialRule& rule, Quantity quantity, const MapRule& map, const RecipeLibrary& library) {
  if (map.recipe.starts_with(k_grain_prefix)) {
    const GrainOptions options;
    HeightMap made = make_test_grain(rule, map.recipe, options).relief;
    for (float& v : made.mm) v /= static_cast<float>(options.height_mm);
    return made;
  }
  std::error_code error;
  if (!std::filesystem::exists(map.picture, error) && looks_like_recipe(map.recipe, library)) {
    RenderedTexture made = render_tile(compile_recipe(rule, map.picture, map.recipe, key_of_map(quantity), library),
                                       1U << static_cast<unsigned>(Channel::bump));
    std::vector<float>& bump = made.values.channels[static_cast<std::size_t>(Channel::bump)];
    return {made.width, made.height, adopted_values(std::move(bump)), 1, 1, true};
  }
  const auto place = [&](const Error& unread) {
    return "material '" + rule.name + "', " + key_of_map(quantity) + ": " + unread.what();
  };
  try {
    Picture picture = read_reduced_picture(map.picture, k_most_samples);
    return {picture.grey.width, picture.grey.height, std::move(picture.grey.pixels), 1, 1, false};
  } catch (const IoError& unread) {
    std::vector<std::string_view> recipes;
    for (const auto& [name, recipe] : library.recipes()) recipes.push_back(name);
    throw IoError(place(unread) + did_you_mean(map.recipe, recipes));
  } catch (const InvalidInput& unread) {
    throw InvalidInput(place(unread));
  }
}

}  // namespace

SourcePicture painted_source(const MaterialRule& rule, PaintedSurface painted) {
  const SurfaceRanges& ranges = painted.ranges;
  SurfacePicture& picture = painted.picture;
  SourcePicture source;
  source.computed = true;
  source.friction = ranges.friction.mean();
  source.stiffness = ranges.stiffness.mean(), source.damping = ranges.damping.mean();
  source.shine = shine_of(painted, rule.roughness, rule.metallic);
  source.color = color_of(picture);
  source.grey = {picture.width, picture.height, adopted_values(std::move(picture.bump)), 0, 32};
  source.maps = QuantityMaps{.width = picture.width, .height = picture.height, .periodic = painted.repeats, .maps = {}};
  source.maps->maps = {
      over_mean(Quantity::stiffness, adopted_values(std::move(picture.stiffness)), source.stiffness),
      over_mean(Quantity::dynamic_friction, adopted_values(std::move(picture.friction)), *source.friction),
      over_mean(Quantity::damping, adopted_values(std::move(picture.damping)), source.damping)};
  return source;
}

SourcePicture read_source(const MaterialRule& rule, const RecipeLibrary& library) {
  if (rule.recipe.starts_with(k_grain_prefix)) return synthesized_source(rule);
  if (const auto recipe = recipe_of(rule, library, true)) return computed_source(rule, *recipe);
  try {
    Picture picture = read_reduced_picture(rule.texture, k_most_grain_side, k_height_bytes_per_pixel + 3);
    return {std::move(picture.grey), std::move(picture.color),
            transfer_of_file(rule.height.relief.height.transfer, picture)};
  } catch (const IoError& unread) {
    std::vector<std::string_view> recipes;
    for (const auto& [name, recipe] : library.recipes()) recipes.push_back(name);
    throw IoError("material '" + rule.name + "', texture: " + unread.what() + did_you_mean(rule.recipe, recipes));
  } catch (const InvalidInput& unread) {
    throw InvalidInput("material '" + rule.name + "', texture: " + unread.what());
  }
}

std::string key_of_map(Quantity quantity) { return "maps/" + std::string(map_key(quantity)); }

std::vector<Digest> picture_digests(const MaterialRule& rule, const RecipeLibrary& library) {
  std::vector<Digest> digests;
  const auto add = [&](const std::filesystem::path& file, const std::string& recipe, const std::string& key) {
    std::error_code error;
    if (recipe.starts_with(k_grain_prefix)) return;
    if (std::filesystem::is_regular_file(file, error)) {
      const std::string bytes = read_file(file);
      digests.push_back(sha256(bytes.data(), bytes.size()));
    } else if (looks_like_recipe(recipe, library)) {
      compile_recipe(rule, file, recipe, key, library, true, &digests);
    }
  };
  add(rule.texture, rule.recipe, "texture");
  for (const auto& image : rule.height.images) add(image, {}, "height.images");
  for (const auto& [quantity, map] : rule.maps) add(map.picture, map.recipe, key_of_map(quantity));
  return digests;
}

QuantityMaps read_maps(const MaterialRule& rule, std::optional<QuantityMaps> of_recipe, const RecipeLibrary& library) {
  QuantityMaps all = std::move(of_recipe).value_or(QuantityMaps{});
  std::erase_if(all.maps, [&](const QuantityMap& map) { return rule.maps.contains(map.quantity); });
  std::map<Quantity, HeightMap> read;
  for (const auto& [quantity, map] : rule.maps) {
    const HeightMap& grey = read[quantity] = read_map(rule, quantity, map, library);
    if (all.maps.empty()) {
      all.periodic = read.size() == 1 ? grey.periodic : all.periodic && grey.periodic;
      all.width = std::max(all.width, grey.width), all.height = std::max(all.height, grey.height);
    }
  }
  for (const auto& [quantity, map] : rule.maps) {
    HeightMap grey = std::move(read[quantity]);
    const auto [low, high] = std::minmax_element(grey.mm.begin(), grey.mm.end());
    const float least = *low, most = *high;
    if (grey.width != all.width || grey.height != all.height) grey = resample(grey, all.width, all.height);
    // A resampled edge rings.
    for (float& v : grey.mm)
      v = static_cast<float>(map.range[0] + (map.range[1] - map.range[0]) *
                                                std::clamp(static_cast<double>(std::clamp(v, least, most)), 0.0, 1.0));
    all.maps.push_back({quantity, std::move(grey.mm)});
  }
  return all;
}

std::optional<ProceduralTexture> recipe_of(const MaterialRule& rule, const RecipeLibrary& library, bool seamless) {
  std::error_code error;
  if (rule.recipe.starts_with(k_grain_prefix) || std::filesystem::exists(rule.texture, error) ||
      !looks_like_recipe(rule.recipe, library))
    return std::nullopt;
  return compile_recipe(rule, rule.texture, rule.recipe, "texture", library, seamless);
}

bool reads_surface(const ProceduralTexture& texture) {
  return texture.depends_on_normal() || texture.depends_on_position() || texture.depends_on_sky() ||
         texture.depends_on_flow();
}

}  // namespace papilla
