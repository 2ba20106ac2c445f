// SPDX-License-Identifier: MIT
// The decals of a studio's scene.
#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "object_textures/box_clip.hpp"
#include "papilla/pipeline/grain.hpp"
#include "papilla/pipeline/studio/studio_scene.hpp"
#include "studio/file_stamp.hpp"
#include "studio/made_surface.hpp"

namespace papilla {
namespace {

/// What decals take from the material of a surface.
Material material_below(const StudioSurface& surface) {
  Material below;
  if (const Material* material = material_of(surface))
    below.roughness = material->roughness, below.metallic = material->metallic;
  return below;
}

}  // namespace

std::vector<StudioDecalWish> StudioScene::decal_wishes(const Materials& rules, const ObjectTexturePlaces& places,
                                                       const std::vector<std::string>& texts,
                                                       const std::vector<StudioWish>& wishes) const {
  std::vector<StudioDecalWish> decals;
  if (rules.decals.empty()) return decals;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::uint32_t, const StudioWish*>>
      shown;  // By node, slot.
  for (const StudioWish& wish : wishes)
    for (const std::uint32_t use : wish.uses) shown[{uses_[use].node, wish.slot}] = {use, &wish};
  for (std::size_t i = 0; i < rules.decals.size(); ++i) {
    StudioDecalWish& decal = decals.emplace_back();
    decal.number = i;
    decal.problem = places.decal_uses[i].problem;
    decal.key = texts.at(i) + " " + file_stamp(rules.decals[i].picture);
    const BoxFrame frame(rules.decals[i].box);
    for (const PlacedSurface& place : places.decals[i]) {
      const auto found = shown.find({place.node, place.slot});
      if (found == shown.end()) continue;
      const auto [use, wish] = found->second;
      if (!may_meet(bounds_[wish->part], uses_[use].world, frame)) continue;
      decal.below.push_back({wish->key, wish->part, wish->slot, use, wish->material});
      decal.key += "\n" + std::to_string(use) + " " + wish->key;
    }
  }
  return decals;
}

std::shared_ptr<const DecalPicture> StudioScene::decal_picture(const std::filesystem::path& file) const {
  const std::string key = file.string() + "\n" + file_stamp(file);
  const std::scoped_lock lock(pictures_mutex_);
  const auto known =
      std::find_if(pictures_.begin(), pictures_.end(), [&](const auto& entry) { return entry.first == key; });
  if (known != pictures_.end()) {
    pictures_.splice(pictures_.begin(), pictures_, known);
  } else {
    pictures_.emplace_front(key, std::make_shared<const DecalPicture>(read_decal_picture(file)));
    if (pictures_.size() > k_most_pictures) pictures_.pop_back();
  }
  return pictures_.front().second;
}

StudioDecal StudioScene::decal(const StudioPlan& plan, const StudioDecalWish& wish,
                               const std::vector<std::shared_ptr<const StudioSurface>>& surfaces) const {
  Scene scene;
  scene.format = scene_.format;
  scene.up = scene_.up;
  ObjectTexturePlaces places;
  places.decals.resize(plan.rules.decals.size());
  for (std::uint32_t i = 0; i < wish.below.size(); ++i) {
    const StudioDecalWish::Below& below = wish.below[i];
    Part part;
    part.name = surfaces.at(i)->label;
    part.mesh = triangle_mesh(surfaces[i]->mesh);
    // A bake shades the patch by its own shape then.
    if (scene_.parts.at(below.part).mesh.normals.empty()) part.mesh.normals = {};
    part.materials = {i};
    scene.parts.push_back(std::move(part));
    scene.materials.push_back(material_below(*surfaces[i]));
    Node node;
    node.part = i;
    node.local = uses_.at(below.use).world;
    scene.nodes.push_back(std::move(node));
    scene.roots.push_back(i);
    places.decals.at(wish.number).push_back({i, 0});
  }
  places.nodes = scene.nodes.size();
  ObjectTextureOptions options;
  options.decal_picture = [this](const std::filesystem::path& file) { return decal_picture(file); };
  options.decal = wish.number;
  options.diagonal_mm = scene_box_.diagonal();
  options.constants = [&](std::uint32_t part, std::uint32_t) -> std::optional<MaterialTag> {
    const auto rule = plan.rules.materials.find(wish.below[part].material);
    if (rule == plan.rules.materials.end() || !is_felt(*surfaces[part])) return std::nullopt;
    return surface_tag(rule->second, nullptr, 0);
  };
  StudioDecal decal;
  decal.key = wish.key;
  decal.report = apply_object_textures(scene, plan.rules, places, options).decals.at(0);
  decal.warnings = std::move(scene.warnings);
  const ProjectorBox& box = plan.rules.decals.at(wish.number).box;
  for (std::uint32_t i = 0; i < wish.below.size(); ++i)
    for (const std::uint32_t child : scene.nodes[i].children) {
      const Part& patch = scene.parts.at(scene.nodes[child].part.value());
      StudioSurface surface;
      surface.part = wish.below[i].part, surface.slot = wish.below[i].slot;
      surface.label = patch.name;
      surface.key = wish.key;
      surface.mesh = shown_mesh(patch.mesh);
      surface.mm_per_uv = {box.width_mm, box.height_mm};
      Scene look;
      look.materials = {scene.materials.at(patch.materials.at(0))};
      look.textures = scene.textures;
      look.images = scene.images;
      surface.look = std::make_shared<const Scene>(std::move(look));
      decal.patches.push_back({std::make_shared<const StudioSurface>(std::move(surface)), wish.below[i].use});
    }
  return decal;
}

}  // namespace papilla
