// SPDX-License-Identifier: MIT
#include "bake_solid.hpp"

#include <fmt/core.h>

#include <iterator>
#include <optional>
#include <utility>

#include "grain_source.hpp"
#include "solid_grain.hpp"
#include "surface/atlas_uv.hpp"
#include "surface/painted_surface.hpp"
#include "surface/surface_atlas.hpp"
#include "surface/surface_texels.hpp"

namespace papilla {
namespace {

/// The texels of one repeat, those of the tile.
int texels_per_repeat(const Grain& tile) { return tile.relief.width; }

}  // namespace

std::vector<SolidGrain> paint_solid(Scene& scene, std::span<const SolidUse> uses, const RecipeLibrary& library,
                                    const ProgressCallback& progress) {
  const std::vector<Instance> all = instances(scene);
  std::optional<SkyView> sky;
  const auto sky_of_scene = [&]() -> const SkyView& {
    if (!sky) sky = sky_of(scene, all, k_solid_sky_rays);
    return *sky;
  };
  std::optional<StainField> stains;
  std::vector<SolidGrain> made;
  std::vector<NewUv> uv;
  for (const SolidUse& use : uses) {
    report_progress(progress, "solid " + use.rule->name,
                    static_cast<double>(made.size()) / static_cast<double>(uses.size()));
    const ProceduralTexture texture = recipe_of(*use.rule, library, false).value(),
                            tiling = recipe_of(*use.rule, library, true).value();
    const SurfaceReading reading = reading_of(texture);
    const MaterialSurface surface =
        lay_out(scene, all, use.material, &scene.materials[use.material].normal_texture.value(),
                texels_per_repeat(*use.tile), k_solid_atlas_side, reading, sky_of_scene);
    if (!(surface.mm_per_repeat > 0)) {  // Nothing shows it.
      made.push_back({*use.tile, true, 0});
      continue;
    }
    if (texture.depends_on_flow() && !stains) stains = stains_of(scene, all);
    PaintedSurface painted = paint_surface(surface, {.texture = texture,
                                                     .tiling = tiling,
                                                     .reading = reading,
                                                     .stains = texture.depends_on_flow() ? &*stains : nullptr});
    std::move(painted.uv.begin(), painted.uv.end(), std::back_inserter(uv));
    SolidGrain solid;
    solid.repeats = painted.repeats;
    solid.charts = surface.atlas.charts.size();
    solid.grain =
        solid_grain(*use.rule, *use.tile, std::move(painted), fmt::format("{}.{}", use.rule->name, made.size() + 1));
    made.push_back(std::move(solid));
  }
  if (!uv.empty()) set_atlas_uv(scene, all, std::move(uv), {});
  return made;
}

}  // namespace papilla
