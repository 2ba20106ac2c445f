// SPDX-License-Identifier: MIT
#include "papilla/pipeline/studio/studio_scene.hpp"

#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <tuple>

#include "../json_value.hpp"
#include "../prepared_bake.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/io/node_places.hpp"
#include "papilla/meshing/mesh_assembly.hpp"
#include "papilla/meshing/mesh_bounds.hpp"
#include "papilla/pipeline/assignment.hpp"
#include "papilla/pipeline/hex_colour.hpp"
#include "papilla/pipeline/part_statistics.hpp"
#include "papilla/pipeline/studio/parse_materials.hpp"
#include "studio/file_stamp.hpp"
#include "studio/made_surface.hpp"
#include "studio/map_ahead.hpp"

namespace papilla {
namespace {

using Json = JsonValue::Json;

std::vector<std::uint32_t> slots_of(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return {};
  if (mesh.material.empty()) return {0};
  const std::set<std::uint32_t> slots(mesh.material.begin(), mesh.material.end());
  return {slots.begin(), slots.end()};
}

/// A triangle for each slot: all that rules look at.
TriangleMesh bones(const std::vector<std::uint32_t>& slots) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}};
  mesh.triangles.assign(slots.size(), {0, 0, 0});
  mesh.material.assign(slots.begin(), slots.end());
  return mesh;
}

std::string escaped(const std::string& name) {
  std::string pattern;
  for (const char c : name) {
    if (std::string_view("*?[]\\").find(c) != std::string_view::npos) pattern += '\\';
    pattern += c;
  }
  return pattern;
}

/// What is made of a material's files depends on this, too.
std::string stamps_of(const MaterialRule& rule) {
  std::string stamps;
  const auto add = [&](const std::filesystem::path& file) {
    if (const std::string stamp = file_stamp(file); !stamp.empty()) stamps += "\nfile " + stamp;
  };
  add(rule.texture), add(rule.environment);
  for (const std::filesystem::path& image : rule.height.images) add(image);
  for (const auto& [quantity, map] : rule.maps) add(map.picture);
  return stamps;
}

/// A material's JSON without what its grain does not depend on.
std::string grain_key(Json material) {
  if (material.is_object()) material.erase("unwrap"), material.erase("phase_mm"), material.erase("$comment");
  return material.dump();
}

/// Whether the tag of the scene's one part lies on its second texture coordinates.
bool is_felt_on_uv1(const Scene& scene) {
  const Part& part = scene.parts[0];
  if (part.materials.empty()) return false;
  const auto& tag = scene.materials[part.materials[0]].haptic;
  return tag && tex_coord_of(*tag) == 1;
}

/// Takes over the mesh of a scene of one part, and the look that is left.
void take_shown(Scene scene, StudioSurface& surface) {
  surface.mesh = shown_mesh(scene.parts[0].mesh, surface.report.distortion, is_felt_on_uv1(scene));
  scene.parts.clear();
  scene.nodes.clear();
  scene.roots.clear();
  surface.look = std::make_shared<const Scene>(std::move(scene));
}

/// What carriers leave of a surface depends on this. @param replace of the document.
std::string without(const Materials& rules, const Json& replace, const StudioWish& wish) {
  if (wish.carriers.empty()) return {};
  std::string text;
  for (const std::size_t i : wish.carriers) {
    if (!rules.replace[i].box) return "\nwithout all";
    text += "\nwithout " + std::to_string(wish.uses.front());
    for (const char* key : {"at", "direction", "up", "size_mm", "depth_mm"}) text += " " + replace.at(i).at(key).dump();
  }
  return text;
}

}  // namespace

StudioScene::StudioScene(Scene scene, const BakeOptions& options, bool in_place, std::string name)
    : name_(std::move(name)), scene_(std::move(scene)), options_(options) {
  const std::vector<NodePlace> places = node_places(scene_);
  for (const Instance& use : instances(scene_)) uses_.push_back({use.node, use.part, use.world, places[use.node].path});
  for (const Part& part : scene_.parts) slots_.push_back(slots_of(part.mesh));
  std::vector<TriangleMesh> meshes;
  for (std::size_t p = 0; p < scene_.parts.size(); ++p)
    meshes.push_back(std::exchange(scene_.parts[p].mesh, bones(slots_[p])));
  skeleton_ = scene_;
  skeleton_.images.clear();
  skeleton_.textures.clear();
  for (std::size_t p = 0; p < scene_.parts.size(); ++p) scene_.parts[p].mesh = std::move(meshes[p]);
  SceneSideOptions sides = options_.plan.sides;
  sides.cache = options_.unwrap.method.cache;
  const auto& view = options_.plan.perception.view;
  const SceneSides found = in_place ? find_sides(scene_, sides, view) : turn_sheets(scene_, sides, view);
  if (found.viewpoint == Viewpoint::inside || found.viewpoint == Viewpoint::room) eye_ = found.eye;
  for (const Part& part : scene_.parts) bounds_.push_back(bounds_of(part.mesh));
  scene_box_ = scene_bounds(scene_);
  context_ = unwrap_context(scene_, {});
  in_place_ = in_place;
  options_.plan.sides.keep = true;
  shares_copies_ = !options_.plan.keep_copies;
  options_.plan.keep_copies = true;
  options_.plan.perception = {};
  options_.plan.budget.reset();
}

std::vector<SurfaceSelector> StudioScene::selectors(std::uint32_t part, std::uint32_t slot) const {
  const Part& wanted = skeleton_.parts.at(part);
  SurfaceSelector common;
  if (slots_[part].size() > 1 && slot < wanted.materials.size()) {
    const Material& material = skeleton_.materials[wanted.materials[slot]];
    if (!material.name.empty()) common.gltf_material = escaped(material.name);
    const auto has_name = [&](std::uint32_t other) {
      return other < wanted.materials.size() && skeleton_.materials[wanted.materials[other]].name == material.name;
    };
    if (std::count_if(slots_[part].begin(), slots_[part].end(), has_name) > 1)
      common.cad_colour = hex_colour(material.base_color);
  }
  common.part = escaped(shown_name(wanted));
  if (is_only_of_its_name(part)) return {common};
  std::vector<SurfaceSelector> selectors;
  for (const StudioUse& use : uses_) {
    if (use.part != part) continue;
    selectors.push_back(common);
    selectors.back().node = escaped(use.path);
  }
  return selectors;
}

bool StudioScene::is_only_of_its_name(std::uint32_t part) const {
  const std::string& name = shown_name(skeleton_.parts.at(part));
  return std::count_if(skeleton_.parts.begin(), skeleton_.parts.end(),
                       [&](const Part& other) { return shown_name(other) == name; }) == 1;
}

SurfaceSelector StudioScene::selector_of_use(std::uint32_t use) const {
  const StudioUse& wanted = uses_.at(use);
  SurfaceSelector selector;
  selector.part = escaped(shown_name(skeleton_.parts.at(wanted.part)));
  if (!is_only_of_its_name(wanted.part)) selector.node = escaped(wanted.path);
  return selector;
}

StudioPlan StudioScene::plan(const std::string& document, const std::filesystem::path& path,
                             const std::filesystem::path& library) const {
  StudioPlan plan;
  plan.rules = parse_materials(document, path, library);
  const Json json = parse_json(document, path.string()), materials = json.at("materials");
  Scene skeleton = skeleton_;
  const Assignment assignment = assign_materials(skeleton, plan.rules);
  plan.uses = assignment.uses;
  const ObjectTexturePlaces places = find_object_textures(skeleton_, plan.rules);
  const CarriersOf carriers_at = carriers_of(plan.rules, places);
  const Json replace = json.value("replace", Json::array());
  std::vector<std::uint32_t> parts;  // Of the skeleton, of each use.
  // By part of the skeleton, slot, carriers, and use where a region takes a part of it.
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::vector<std::size_t>, std::optional<std::uint32_t>>,
           std::size_t>
      known;
  for (std::uint32_t u = 0; u < uses_.size(); ++u) {
    const std::uint32_t original = uses_[u].part, part = skeleton.nodes[uses_[u].node].part.value_or(original);
    parts.push_back(part);
    for (const std::uint32_t slot : slots_[original]) {
      const auto taken = carriers_at.find({uses_[u].node, slot});
      const std::vector<std::size_t> carriers = taken == carriers_at.end() ? std::vector<std::size_t>() : taken->second;
      const bool by_regions = !carriers.empty() && std::all_of(carriers.begin(), carriers.end(), [&](std::size_t i) {
        return plan.rules.replace[i].box.has_value();
      });
      const auto alone = by_regions ? std::optional(u) : std::nullopt;
      const auto [place, is_new] = known.try_emplace({part, slot, carriers, alone}, plan.wishes.size());
      if (is_new) {
        StudioWish wish{original, slot, {u}, {}, {}, {}, {}, carriers};
        const Part& shown = skeleton.parts[part];
        wish.label = assignment.parts[part].is_split ? shown.id : shown_name(shown);
        if (slots_[original].size() > 1)
          wish.label += "/" + (slot < shown.materials.size() ? skeleton.materials[shown.materials[slot]].name
                                                             : std::to_string(slot));
        if (const MaterialRule* rule = assignment.parts[part].rule_of(slot)) wish.material = rule->name;
        wish.key = name_ + " " + std::to_string(original) + "/" + std::to_string(slot);
        if (!wish.material.empty()) {
          wish.rule = materials.at(wish.material).dump();
          wish.files = stamps_of(plan.rules.materials.at(wish.material));
        }
        wish.key +=
            " " + wish.label + " " + wish.material + " " + wish.rule + wish.files + without(plan.rules, replace, wish);
        plan.wishes.push_back(std::move(wish));
      } else {
        plan.wishes[place->second].uses.push_back(u);
      }
    }
  }
  std::vector<std::string> decals;
  for (const Json& decal : json.value("decals", Json::array())) decals.push_back(decal.dump());
  plan.decals = decal_wishes(plan.rules, places, decals, plan.wishes);
  if (plan.rules.replace.empty()) return plan;
  std::string pictures;
  for (const CarrierRule& carrier : plan.rules.replace) pictures += " " + file_stamp(carrier.picture);
  plan.carriers = carrier_wish(replace.dump() + pictures, parts, plan.wishes);
  plan.carriers->selected = places.carrier_uses;
  return plan;
}

Scene StudioScene::piece(std::uint32_t number, std::uint32_t slot, const std::string& name) const {
  const Part& part = scene_.parts.at(number);
  Scene scene;
  scene.format = scene_.format;
  scene.up = scene_.up;
  Part own;
  own.name = name;
  own.id = part.id;
  if (slots_[number].size() == 1) {
    own.mesh = part.mesh;
  } else {
    std::vector<Index> triangles;
    for (Index t = 0; t < part.mesh.triangles.size(); ++t)
      if (part.mesh.material[t] == slot) triangles.push_back(t);
    own.mesh = extract_triangles(part.mesh, triangles);
  }
  own.mesh.material.clear();
  if (slot < part.materials.size()) {
    Material material = scene_.materials[part.materials[slot]];
    TakenPictures(scene_, scene).take_all(material);
    material.extensions_json.clear();  // They name textures by numbers of the whole scene.
    scene.materials.push_back(std::move(material));
    own.materials = {0};
  }
  scene.parts.push_back(std::move(own));
  Node node;
  node.part = 0;
  scene.nodes.push_back(std::move(node));
  scene.roots = {0};
  return scene;
}

Grain StudioScene::grain_of(const std::string& key, const MaterialRule& rule) {
  const std::scoped_lock lock(grains_mutex_);
  const auto known =
      std::find_if(grains_.begin(), grains_.end(), [&](const auto& entry) { return entry.first == key; });
  if (known != grains_.end()) {
    grains_.splice(grains_.begin(), grains_, known);
  } else {
    grains_.emplace_front(
        key, make_shown_grain(rule, options_.library, options_.unwrap.method.deadline, options_.unwrap.method.cache));
    if (grains_.size() > k_most_grains) grains_.pop_back();
  }
  return grains_.front().second;
}

bool StudioScene::is_new_map(const StudioWish& wish, const std::string& unwrap) {
  const std::scoped_lock lock(mapped_mutex_);
  return mapped_.insert(std::to_string(wish.part) + "/" + std::to_string(wish.slot) + " " + unwrap).second;
}

StudioSurface StudioScene::as_read(std::uint32_t part, std::uint32_t slot) const {
  Scene scene = piece(part, slot, {});
  StudioSurface surface;
  surface.part = part, surface.slot = slot;
  surface.label = shown_name(scene_.parts[part]);
  surface.key = std::to_string(part) + "/" + std::to_string(slot);
  take_shown(std::move(scene), surface);
  return surface;
}

BakeResult StudioScene::bake_piece(const StudioPlan& plan, const StudioWish& wish, bool paints,
                                   const ProgressCallback& progress) {
  const MaterialRule& rule = plan.rules.materials.at(wish.material);
  Materials rules;
  rules.source = plan.rules.source;
  rules.materials.emplace(rule.name, rule);
  AssignRule all;
  all.part = "*";
  all.material = rule.name;
  rules.assign.push_back(std::move(all));
  GrainMaker maker(rules, options_.library, options_.unwrap.method.deadline, options_.unwrap.method.cache);
  report_progress(progress, wish.label, 0);
  const WholeScene whole{context_, in_place_};
  Scene scene = piece(wish.part, wish.slot, wish.label);
  if (!rule.texture.empty()) {
    const Json material = parse_json(wish.rule, plan.rules.source);
    Grain grain;
    oneapi::tbb::parallel_invoke([&] { grain = grain_of(grain_key(material) + wish.files, rule); },
                                 [&] {
                                   if (is_new_map(wish, material.value("unwrap", Json()).dump()))
                                     map_ahead(scene, rules, rule, options_, whole);
                                 });
    grain.solid = grain.solid && paints;
    maker.put(rule.name, std::move(grain));
  }
  report_progress(progress, wish.label, 0.5);
  return bake_scene(std::move(scene), rules, options_, maker, progress, &whole);
}

StudioSurface StudioScene::bake(const StudioPlan& plan, const StudioWish& wish, const ProgressCallback& progress) {
  const Stopwatch clock;
  if (wish.material.empty()) {
    Scene scene = piece(wish.part, wish.slot, {});
    StudioSurface surface;
    surface.part = wish.part, surface.slot = wish.slot;
    surface.label = wish.label;
    surface.key = wish.key;
    take_out(plan, wish, scene.parts[0].mesh, surface);
    take_shown(std::move(scene), surface);
    surface.seconds = clock.seconds();
    return surface;
  }
  BakeResult result = bake_piece(plan, wish, true, progress);
  StudioSurface surface;
  surface.part = wish.part, surface.slot = wish.slot;
  surface.label = wish.label;
  surface.key = wish.key;
  if (!result.surfaces.empty()) {
    surface.report = std::move(result.surfaces.front());
    surface.report.part = wish.part, surface.report.slot = wish.slot;
  }
  surface.report.mesh = {};
  if (!result.scene.parts[0].materials.empty())
    surface.mm_per_uv = result.mm_per_uv.at(result.scene.parts[0].materials[0]);
  surface.warnings = result.scene.warnings;
  take_out(plan, wish, result.scene.parts[0].mesh, surface);
  take_shown(std::move(result.scene), surface);
  surface.report.distortion.per_triangle.clear();
  surface.seconds = clock.seconds();
  return surface;
}

}  // namespace papilla
