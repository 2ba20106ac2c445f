// SPDX-License-Identifier: MIT
// The carriers of a studio's scene.
#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "object_textures/box_clip.hpp"
#include "object_textures/piece.hpp"
#include "papilla/meshing/mesh_assembly.hpp"
#include "papilla/pipeline/grain.hpp"
#include "papilla/pipeline/shared_parts.hpp"
#include "papilla/pipeline/studio/studio_scene.hpp"
#include "studio/made_surface.hpp"

namespace papilla {
namespace {

constexpr std::uint32_t k_no_material = 0xffffffffu;

/// Those of which uses show which part: the first one of each part that is left after equal ones were shared.
std::vector<const StudioCarrierWish::Use*> shared_uses(Scene& scene,
                                                       std::vector<const StudioCarrierWish::Use*> firsts) {
  std::map<std::string, std::uint64_t> labels;
  const auto shared = share_identical_parts(scene, [&](std::uint32_t part) {
    return labels.try_emplace(firsts[part]->materials, labels.size()).first->second;
  });
  std::set<std::uint32_t> copies;
  for (const SharedPart& part : shared) copies.insert(part.number);
  std::vector<const StudioCarrierWish::Use*> kept;
  for (std::uint32_t p = 0; p < firsts.size(); ++p)
    if (!copies.contains(p)) kept.push_back(firsts[p]);
  return kept;
}

/// For each node the one of the first `count` that it is or is below.
std::vector<std::optional<std::uint32_t>> owners(const Scene& scene, std::uint32_t count) {
  std::vector<std::optional<std::uint32_t>> owner(scene.nodes.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    std::vector<std::uint32_t> below = {i};
    while (!below.empty()) {
      const std::uint32_t node = below.back();
      below.pop_back();
      owner[node] = i;
      below.insert(below.end(), scene.nodes[node].children.begin(), scene.nodes[node].children.end());
    }
  }
  return owner;
}

}  // namespace

StudioScene::CarriersOf StudioScene::carriers_of(const Materials& rules, const ObjectTexturePlaces& places) const {
  CarriersOf result;
  if (rules.replace.empty()) return result;
  std::map<std::uint32_t, const StudioUse*> use_of;
  for (const StudioUse& use : uses_) use_of[use.node] = &use;
  for (std::size_t i = 0; i < rules.replace.size(); ++i) {
    const auto& box = rules.replace[i].box;
    for (const PlacedSurface& place : places.carriers[i]) {
      const auto use = use_of.find(place.node);
      if (use == use_of.end()) continue;
      if (!box || may_meet(bounds_[use->second->part], use->second->world, BoxFrame(*box)))
        result[{place.node, place.slot}].push_back(i);
    }
  }
  return result;
}

StudioCarrierWish StudioScene::carrier_wish(const std::string& text, const std::vector<std::uint32_t>& parts,
                                            const std::vector<StudioWish>& wishes) const {
  std::map<std::uint32_t, StudioCarrierWish::Use> uses;
  for (const StudioWish& wish : wishes)
    for (const std::uint32_t u : wish.uses) {
      StudioCarrierWish::Use& use = uses[u];
      use.use = u;
      use.part = parts[u];
      use.materials += std::to_string(wish.slot) + " " + wish.material + "\n";
      if (!wish.carriers.empty()) use.surfaces.push_back({wish.key, wish.slot, wish.material, wish.carriers});
    }
  StudioCarrierWish result;
  result.key = text;
  for (auto& [u, use] : uses) {
    if (use.surfaces.empty()) continue;
    result.key += "\n" + std::to_string(u) + " " + use.materials;
    for (const StudioCarrierWish::Surface& surface : use.surfaces) result.key += " " + surface.surface;
    result.uses.push_back(std::move(use));
  }
  return result;
}

void StudioScene::take_out(const StudioPlan& plan, const StudioWish& wish, TriangleMesh& mesh,
                           StudioSurface& surface) const {
  if (wish.carriers.empty()) return;
  surface.whole = std::make_shared<const TriangleMesh>(mesh);
  const Transform& world = uses_.at(wish.uses.front()).world;
  const auto is_taken = [&](Index t) {
    return std::any_of(wish.carriers.begin(), wish.carriers.end(), [&](std::size_t i) {
      const auto& box = plan.rules.replace[i].box;
      return !box || is_within(mesh, t, world, BoxFrame(*box));
    });
  };
  std::vector<Index> kept;
  std::vector<TriangleDistortion>& measured = surface.report.distortion.per_triangle;
  std::vector<TriangleDistortion> kept_measured;
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    if (is_taken(t)) continue;
    kept.push_back(t);
    if (t < measured.size()) kept_measured.push_back(measured[t]);
  }
  measured = std::move(kept_measured);
  mesh = extract_triangles(mesh, kept);
}

StudioCarriers StudioScene::carriers(
    const StudioPlan& plan, const std::map<std::string, std::shared_ptr<const StudioSurface>>& surfaces) const {
  const StudioCarrierWish& wish = plan.carriers.value();
  const auto made = [&](const std::string& key) -> const StudioSurface* {
    const auto found = surfaces.find(key);
    return found == surfaces.end() ? nullptr : found->second.get();
  };
  Scene scene;
  scene.format = scene_.format;
  scene.up = scene_.up;
  scene.materials = scene_.materials;
  ObjectTexturePlaces places;
  places.carriers.resize(plan.rules.replace.size());
  std::vector<const StudioCarrierWish::Use*> firsts;  // Of each part.
  std::map<std::uint32_t, std::uint32_t> part_of;
  std::map<std::pair<std::uint32_t, std::uint32_t>, const StudioCarrierWish::Surface*> known;  // By part and slot.
  for (const StudioCarrierWish::Use& use : wish.uses) {
    const StudioUse& shown = uses_.at(use.use);
    const auto [place, is_new] = part_of.try_emplace(use.part, static_cast<std::uint32_t>(scene.parts.size()));
    if (is_new) {
      scene.parts.push_back(scene_.parts[shown.part]);
      firsts.push_back(&use);
    }
    const auto number = static_cast<std::uint32_t>(scene.nodes.size());
    Node node;
    node.name = scene_.nodes[shown.node].name;
    node.part = place->second;
    node.local = shown.world;
    scene.nodes.push_back(std::move(node));
    scene.roots.push_back(number);
    for (const StudioCarrierWish::Surface& surface : use.surfaces) {
      known.try_emplace({use.part, surface.slot}, &surface);
      for (const std::size_t i : surface.carriers) places.carriers[i].push_back({number, surface.slot});
    }
  }
  places.nodes = scene.nodes.size();
  if (shares_copies_) firsts = shared_uses(scene, std::move(firsts));
  // From here on the parts are as they were baked.
  scene.materials.clear();
  for (std::size_t p = 0; p < firsts.size(); ++p) {
    const std::uint32_t original = uses_[firsts[p]->use].part;
    Part part;
    part.name = scene.parts[p].name;
    part.id = scene.parts[p].id;
    for (const std::uint32_t slot : slots_[original]) {
      const auto found = known.find({firsts[p]->part, slot});
      const StudioSurface* surface = found == known.end() ? nullptr : made(found->second->surface);
      const Scene read = surface == nullptr ? piece(original, slot, {}) : Scene();
      const Scene& look = surface == nullptr ? read : *surface->look;
      TriangleMesh mesh = surface == nullptr ? read.parts[0].mesh : *surface->whole;
      mesh.material.assign(mesh.triangles.size(), slot);
      append_mesh(part.mesh, mesh);
      part.materials.resize(std::max<std::size_t>(part.materials.size(), slot + 1), k_no_material);
      if (look.materials.empty()) continue;
      Material material = look.materials.front();
      TakenPictures(look, scene).take_all(material);
      part.materials[slot] = static_cast<std::uint32_t>(scene.materials.size());
      scene.materials.push_back(std::move(material));
    }
    scene.parts[p] = std::move(part);
  }
  const std::size_t materials_before = scene.materials.size();
  Materials rules;
  rules.source = plan.rules.source;
  rules.replace = plan.rules.replace;
  ObjectTextureOptions options;
  options.constants = [&](std::uint32_t part, std::uint32_t slot) -> std::optional<MaterialTag> {
    const auto found = known.find({firsts.at(part)->part, slot});
    if (found == known.end()) return std::nullopt;
    const StudioSurface* surface = made(found->second->surface);
    const auto rule = plan.rules.materials.find(found->second->material);
    if (surface == nullptr || rule == plan.rules.materials.end() || !is_felt(*surface)) return std::nullopt;
    return surface_tag(rule->second, nullptr, 0);
  };
  ObjectTextures result = apply_to_piece(scene, scene_box_, rules, places, options);
  StudioCarriers carriers;
  carriers.key = wish.key;
  carriers.reports = std::move(result.carriers);
  carriers.warnings = std::move(scene.warnings);
  const auto owner = owners(scene, static_cast<std::uint32_t>(wish.uses.size()));
  for (const Instance& shown : instances(scene)) {
    const Part& part = scene.parts[shown.part];
    if (part.mesh.triangles.empty() || part.materials.size() != 1 || part.materials[0] < materials_before) continue;
    StudioSurface surface;
    surface.label = part.name;
    surface.key = wish.key;
    surface.mesh = shown_mesh(part.mesh);
    surface.mm_per_uv = result.mm_per_uv.at(part.materials[0] - materials_before);
    Scene look;
    Material material = scene.materials[part.materials[0]];
    TakenPictures(scene, look).take_all(material);
    look.materials = {std::move(material)};
    surface.look = std::make_shared<const Scene>(std::move(look));
    StudioCarriers::Rectangle rectangle{{}, shown.world, {}};
    if (const auto node = owner[shown.node]) {
      const StudioCarrierWish::Use& use = wish.uses[*node];
      rectangle.use = use.use;
      surface.part = uses_[use.use].part, surface.slot = use.surfaces.front().slot;
    }
    rectangle.surface = std::make_shared<const StudioSurface>(std::move(surface));
    carriers.rectangles.push_back(std::move(rectangle));
  }
  return carriers;
}

}  // namespace papilla
