// SPDX-License-Identifier: MIT
#include "papilla/pipeline/studio/felt_scene.hpp"

#include <map>
#include <utility>

#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/haptic/stimulus.hpp"

namespace papilla {
namespace {

const MaterialTag* tag_of(const StudioSurface& surface) {
  if (!surface.look || surface.look->materials.empty()) return nullptr;
  const auto& tag = surface.look->materials.front().haptic;
  return tag ? &*tag : nullptr;
}

Vec3 vec3_at(const std::vector<float>& values, std::size_t i) {
  return {double{values[3 * i]}, double{values[3 * i + 1]}, double{values[3 * i + 2]}};
}

/// Distance of a point from the box of a placed surface.
double distance_to_box(const FeltSurface& placed, Vec3 point) {
  Bounds3 box;
  const std::vector<float>& positions = placed.surface->mesh.positions;
  for (std::size_t i = 0; 3 * i < positions.size(); ++i) box.add(transform_point(placed.world, vec3_at(positions, i)));
  return norm(upper(upper(box.low - point, point - box.high), Vec3{}));
}

/// A surface's one material as a part of `scene`, with the images that its tag may name.
std::uint32_t add_part(const StudioSurface& surface, const std::string& model, Scene& scene) {
  Material material = surface.look->materials.front();
  if (!model.empty()) {
    ForceModelTag tag = material.haptic->force_model.value_or(ForceModelTag{});
    tag.name = model;
    if (!stimulus_form(*force_model(model), tag.form)) tag.form.clear();
    material.haptic->force_model = tag;
  }
  Part part;
  part.name = surface.label;
  part.mesh = triangle_mesh(surface.mesh);
  part.materials = {static_cast<std::uint32_t>(scene.materials.size())};
  // Only the transforms of textures are looked at.
  const auto textures = static_cast<std::uint32_t>(scene.textures.size());
  for (auto* reference : {&material.base_color_texture, &material.metallic_roughness_texture, &material.normal_texture,
                          &material.occlusion_texture, &material.emissive_texture})
    if (*reference) (*reference)->texture += textures;
  for (Texture texture : surface.look->textures) {
    const auto images = static_cast<std::uint32_t>(scene.images.size());
    if (texture.image) *texture.image += images;
    for (OtherImage& other : texture.others) other.image += images;
    scene.textures.push_back(std::move(texture));
  }
  scene.images.insert(scene.images.end(), surface.look->images.begin(), surface.look->images.end());
  scene.materials.push_back(std::move(material));
  scene.parts.push_back(std::move(part));
  return static_cast<std::uint32_t>(scene.parts.size() - 1);
}

}  // namespace

std::vector<FeltSurface> felt_surfaces(const std::vector<FeltSurface>& surfaces, Vec3 point_mm, double reach_mm) {
  std::vector<FeltSurface> felt;
  for (const FeltSurface& placed : surfaces)
    if (tag_of(*placed.surface) != nullptr && distance_to_box(placed, point_mm) <= reach_mm) felt.push_back(placed);
  return felt;
}

HapticScene felt_scene(const std::vector<FeltSurface>& surfaces, const std::string& model,
                       const std::filesystem::path& path, const HapticSceneOptions& options) {
  if (!model.empty() && !force_model(model)) throw InvalidInput("there is no force model '" + model + "'");
  Scene scene;
  std::map<const StudioSurface*, std::uint32_t> parts;
  for (const FeltSurface& placed : surfaces) {
    if (tag_of(*placed.surface) == nullptr) continue;
    const auto [known, is_new] = parts.try_emplace(placed.surface.get(), 0);
    if (is_new) known->second = add_part(*placed.surface, model, scene);
    Node node;
    node.part = known->second;
    node.local = placed.world;
    scene.roots.push_back(static_cast<std::uint32_t>(scene.nodes.size()));
    scene.nodes.push_back(std::move(node));
  }
  if (scene.parts.empty()) throw InvalidInput("nothing here has a haptic material");
  return haptic_scene(scene, path, options);
}

}  // namespace papilla
