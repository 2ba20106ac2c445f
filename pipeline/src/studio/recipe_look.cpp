// SPDX-License-Identifier: MIT
#include "papilla/pipeline/studio/recipe_look.hpp"

#include <algorithm>
#include <cmath>

#include "../grain_source.hpp"
#include "../surface/painted_surface.hpp"
#include "papilla/core/error.hpp"
#include "papilla/pipeline/grain.hpp"
#include "papilla/pipeline/recipe_source.hpp"
#include "papilla/procedural/preview.hpp"
#include "papilla/texture/normal_map.hpp"
#include "papilla/texture/texture_class.hpp"

namespace papilla {
namespace {

constexpr double k_common_size_mm = 40;        ///< Of a rule that does not say it yet.
constexpr double k_picture_relief = 1.0 / 24;  ///< Height of 1 in sides of the picture, as on contact sheets.

RenderedTexture rendered(const ProceduralTexture& texture, int side, unsigned channels,
                         const ProgressCallback& progress) {
  require_look_side(side);
  RenderOptions render;
  render.width = render.height = side;
  render.channels = channels;
  render.progress = progress;
  return render_texture(texture, render);
}

/// Normals whose slope exceeds the limit lean as far as that allows.
void cut_slopes(ColorImage& normals, double max_slope) {
  constexpr double k_middle = 127.5;
  for (std::size_t i = 0; i + 2 < normals.pixels.size(); i += 3) {
    const double x = normals.pixels[i] - k_middle, y = normals.pixels[i + 1] - k_middle,
                 z = normals.pixels[i + 2] - k_middle, across = std::hypot(x, y);
    if (across <= max_slope * z) continue;
    const double turned = max_slope / across, length = std::hypot(1.0, max_slope);
    const auto byte = [&](double part) {
      return static_cast<unsigned char>(std::lround(k_middle * (1 + part / length)));
    };
    normals.pixels[i] = byte(x * turned), normals.pixels[i + 1] = byte(y * turned), normals.pixels[i + 2] = byte(1);
  }
}

ColorImage normals_of(const MaterialRule& rule, const PaintedSurface& painted) {
  const SurfacePicture& picture = painted.picture;
  double size[2] = {rule.size_mm[0], rule.size_mm[1]};
  for (double& mm : size)
    if (!(mm > 0)) mm = k_common_size_mm;
  const double depth = depth_mm_of(rule, size) * rule.height.scale;
  HeightMap relief{picture.width,
                   picture.height,
                   Values<float>(picture.bump.begin(), picture.bump.end()),
                   size[0] / painted.texels_per_repeat,
                   size[1] / painted.texels_per_repeat,
                   painted.repeats};
  for (float& h : relief.mm) h *= static_cast<float>(depth);
  ColorImage normals = normal_map(relief);
  const double friction = rule.static_friction.value_or(painted.ranges.friction.mean());
  cut_slopes(normals, rule.height.max_slope.value_or(default_max_slope(friction)));
  return normals;
}

/// @param monochrome  of the tile.
RecipeLook look_of(const MaterialRule& rule, const PaintedSurface& painted, bool monochrome) {
  RecipeLook look;
  look.width = painted.picture.width, look.height = painted.picture.height;
  look.normal = with_alpha(normals_of(rule, painted));
  if (!shows_picture(rule, monochrome)) return look;
  look.color = with_alpha(color_of(painted.picture));
  const Shine shine = shine_of(painted, rule.roughness, rule.metallic);
  look.roughness = shine.roughness, look.metallic = shine.metallic;
  if (shine.picture) look.shine = with_alpha(*shine.picture);
  return look;
}

}  // namespace

ProceduralTexture compile_for_look(const std::string& recipe, const RecipeLibrary& library,
                                   const std::filesystem::path& folder, double time, bool seamless) {
  CompileOptions options = recipe_options(folder);
  options.seamless = seamless;
  options.time = time;
  return compile_texture(recipe, library, options);
}

void require_look_side(int side) {
  constexpr int k_least = 16, k_most = 2048;
  if (side < k_least || side > k_most)
    throw InvalidInput("a look of " + std::to_string(side) + " texels a side; 16 to 2048 can be shown");
}

bool needs_atlas(const ProceduralTexture& texture) { return reads_surface(texture); }

RecipeLook recipe_look(const MaterialRule& rule, const ProceduralTexture& texture, int side,
                       const ProgressCallback& progress) {
  const PaintedSurface painted = painted_repeat(rendered(texture, side, painted_channels(), progress));
  return look_of(rule, painted, rule.show == "auto" && is_monochrome(color_of(painted.picture)));
}

std::vector<RecipeLook> recipe_looks(const MaterialRule& rule, const ProceduralTexture& texture,
                                     const ProceduralTexture& tiling,
                                     std::span<const std::shared_ptr<const RecipeAtlas>> atlases,
                                     const ProgressCallback& progress) {
  constexpr int k_tile_side = 64;
  const auto tile = [&] {
    return color_of(painted_repeat(rendered(tiling, k_tile_side, painted_channels(), progress)).picture);
  };
  const bool monochrome = rule.show == "auto" && is_monochrome(tile());
  const SurfaceReading reading = reading_of(texture);
  std::vector<RecipeLook> looks;
  for (const std::shared_ptr<const RecipeAtlas>& atlas : atlases) {
    const auto report = [&](double share) {
      report_progress(progress, "look",
                      (static_cast<double>(looks.size()) + share) / static_cast<double>(atlases.size()));
    };
    report(0);
    const PaintJob job{.texture = texture,
                       .tiling = tiling,
                       .reading = reading,
                       .stains = atlas->stains.get(),
                       .share_equal = false,
                       .progress = report};
    looks.push_back(look_of(rule, paint_surface(*atlas->surface, job), monochrome));
  }
  return looks;
}

std::vector<unsigned char> recipe_picture(const ProceduralTexture& texture, int side) {
  const RenderedTexture picture = rendered(texture, side, k_preview_channels, {});
  return with_alpha(to_color_image(light_texture(texture, picture, k_picture_relief * side), side, side));
}

}  // namespace papilla
