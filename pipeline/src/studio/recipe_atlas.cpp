// SPDX-License-Identifier: MIT
#include "papilla/pipeline/studio/recipe_atlas.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "../bake_solid.hpp"
#include "../json_value.hpp"
#include "../surface/atlas_uv.hpp"
#include "../surface/painted_surface.hpp"
#include "../surface/surface_atlas.hpp"
#include "../surface/surface_texels.hpp"
#include "papilla/pipeline/studio/recipe_look.hpp"

namespace papilla {
namespace {

/// A material's JSON without what its coordinates do not depend on and an editor of recipes changes.
std::string without_recipe(const std::string& rule) {
  JsonValue::Json json = parse_json(rule, "material");
  for (const char* key : {"texture", "time", "show", "$comment"}) json.erase(key);
  return json.dump();
}

}  // namespace

std::string recipe_atlas_key(const StudioWish& wish, const ProceduralTexture& texture, int side) {
  std::string key = wish.key;
  if (const std::size_t at = key.find(wish.rule); !wish.rule.empty() && at != std::string::npos)
    key.replace(at, wish.rule.size(), without_recipe(wish.rule));
  const SurfaceReading reading = reading_of(texture);
  key += "\n" + std::to_string(side);
  key += reading.position ? " position" : "";
  key += reading.sky ? " sky" : "";
  key += texture.depends_on_flow() ? " flow" : "";
  return key + JsonValue::Json(reading.directions).dump();
}

double StudioScene::area_mm2(std::uint32_t part, std::uint32_t slot) const {
  const TriangleMesh& mesh = scene_.parts.at(part).mesh;
  double area = 0;
  for (Index t = 0; t < mesh.triangles.size(); ++t)
    if (mesh.material.empty() || mesh.material[t] == slot)
      area += 0.5 * norm(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
  return area;
}

std::shared_ptr<const RecipeAtlas> StudioScene::recipe_atlas(const StudioPlan& plan, const StudioWish& wish,
                                                             const ProceduralTexture& texture, int side,
                                                             const ProgressCallback& progress) {
  require_look_side(side);
  BakeResult result = bake_piece(plan, wish, false, progress);
  Scene& scene = result.scene;
  const auto grain = result.grains.find(wish.material);
  if (grain == result.grains.end() || scene.parts[0].materials.empty()) return nullptr;
  const std::uint32_t material = scene.parts[0].materials[0];
  const auto& place = scene.materials[material].normal_texture;
  if (!place) return nullptr;
  const std::vector<Instance> all = instances(scene);
  std::optional<SkyView> sky;
  const auto sky_of_piece = [&]() -> const SkyView& {
    if (!sky) sky = sky_of(scene, all, k_solid_sky_rays);
    return *sky;
  };
  const int texels_per_repeat = std::min(side, grain->second.relief.width);
  auto surface = std::make_shared<MaterialSurface>(
      lay_out(scene, all, material, &*place, texels_per_repeat, side, reading_of(texture), sky_of_piece));
  if (!(surface->mm_per_repeat > 0)) return nullptr;
  auto atlas = std::make_shared<RecipeAtlas>();
  if (texture.depends_on_flow()) atlas->stains = std::make_shared<const StainField>(stains_of(scene, all));
  set_atlas_uv(scene, all, uv_of_own_tiles(*surface), {});
  StudioSurface shown;
  take_out(plan, wish, scene.parts[0].mesh, shown);
  atlas->mesh = shown_mesh(scene.parts[0].mesh);
  atlas->surface = std::move(surface);
  return atlas;
}

}  // namespace papilla
