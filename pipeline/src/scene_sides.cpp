// SPDX-License-Identifier: MIT
#include "papilla/pipeline/scene_sides.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

#include "papilla/cache/stage_cache.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/io/node_places.hpp"
#include "papilla/meshing/orient.hpp"
#include "placed_meshes.hpp"

namespace papilla {
namespace {

PartSides summary_of(const Part& part, const MeshSheets& mesh) {
  PartSides sides;
  sides.part = shown_name(part);
  sides.open_components = mesh.sheets.size();
  std::set<SideReason> reasons;
  for (const SheetSide& sheet : mesh.sheets) {
    sides.facing_away += sheet.faces_away;
    sides.ambiguous += sheet.is_ambiguous();
    reasons.insert(sheet.reason);
  }
  sides.turned_triangles = static_cast<std::size_t>(std::count(mesh.turn.begin(), mesh.turn.end(), 1));
  sides.reasons.assign(reasons.begin(), reasons.end());
  return sides;
}

void add_ambiguous(const Scene& scene, const PartSheets& part, std::set<PartSlot>& slots) {
  const Values<std::uint32_t>& slot = scene.parts[part.part].mesh.material;
  for (const SheetSide& sheet : part.sheets)
    if (sheet.is_ambiguous())
      for (const Index t : sheet.triangles) slots.emplace(part.part, slot.empty() ? 0 : slot[t]);
}

/// A box is turned by quarters, so it stays one.
Volume turned(const Transform& turn, const Volume& volume) {
  if (const auto* box = std::get_if<BoxVolume>(&volume)) {
    Bounds3 bounds;
    for (const Vec3& corner : {box->low, box->high}) bounds.add(transform_point(turn, corner));
    return BoxVolume{bounds.low, bounds.high};
  }
  const auto& sphere = std::get<SphereVolume>(volume);
  return SphereVolume{transform_point(turn, sphere.centre), sphere.radius_mm};
}

/// The rotation back.
Transform transposed(const Transform& t) {
  return {t[0], t[4], t[8], 0, t[1], t[5], t[9], 0, t[2], t[6], t[10], 0, 0, 0, 0, 1};
}

/// What of a part tells its sides, and its name in the result.
struct SeenPart {
  std::string name;
  Digest mesh;  ///< Of positions, triangles and slots.
  std::vector<std::uint32_t> materials;
};

SeenPart seen_part(const Part& part) {
  return {shown_name(part), key_of("seen part", part.mesh.positions, part.mesh.triangles, part.mesh.material),
          part.materials};
}

/// find_sides() without looking into a cache.
SceneSides make_sides(const Scene& scene, const SceneSideOptions& options, std::span<const Volume> view) {
  SceneSides found;
  const Stopwatch clock;
  const Transform turn = to_y_up(scene.up);  // places are looked for along axes: as in the file that is written
  const std::vector<PlacedMesh> uses = placed_meshes(scene, instances(scene), turn);
  SheetSideOptions viewpoint;
  if (options.inside) viewpoint.inside = transform_point(turn, *options.inside);
  for (const Volume& volume : view) viewpoint.view.push_back(turned(turn, volume));
  SheetSides sides;
  try {
    sides = find_sheet_sides(uses, viewpoint);
  } catch (const InvalidInput& error) {
    found.skipped = error.what();
    return found;
  }
  std::unordered_map<const TriangleMesh*, MeshSheets*> of_mesh;
  for (MeshSheets& mesh : sides.meshes)
    if (!mesh.sheets.empty()) of_mesh.emplace(mesh.mesh, &mesh);
  found.viewpoint = sides.viewpoint;
  found.eye = transform_point(transposed(turn), sides.eye);
  found.enclosure = sides.enclosure;
  for (std::uint32_t p = 0; p < scene.parts.size(); ++p) {
    const auto mesh = of_mesh.find(&scene.parts[p].mesh);
    if (mesh == of_mesh.end()) continue;
    found.parts.push_back(summary_of(scene.parts[p], *mesh->second));
    found.open_components += found.parts.back().open_components;
    found.facing_away += found.parts.back().facing_away;
    found.ambiguous += found.parts.back().ambiguous;
    found.sheets.push_back({p, std::move(mesh->second->sheets), std::move(mesh->second->turn)});
  }
  found.seconds = clock.seconds();
  return found;
}

}  // namespace

std::string_view to_string(Viewpoint viewpoint) noexcept {
  switch (viewpoint) {
    case Viewpoint::none: break;
    case Viewpoint::inside: return "inside";
    case Viewpoint::view: return "view";
    case Viewpoint::room: return "room";
    case Viewpoint::around: return "around";
  }
  return "none";
}

std::string_view to_string(SideReason reason) noexcept {
  switch (reason) {
    case SideReason::seen: return "seen";
    case SideReason::neighbour: return "neighbour";
    case SideReason::seen_around: return "seen_around";
    case SideReason::both_sides_seen: return "both_sides_seen";
    case SideReason::unseen: return "unseen";
    case SideReason::non_orientable: break;
  }
  return "non_orientable";
}

void show_both_sides(Scene& scene, const std::set<PartSlot>& slots, bool add_materials) {
  std::vector<std::size_t> other_uses(scene.materials.size(), 0);
  for (std::uint32_t p = 0; p < scene.parts.size(); ++p)
    for (std::uint32_t s = 0; s < scene.parts[p].materials.size(); ++s)
      if (const std::uint32_t m = scene.parts[p].materials[s]; m < other_uses.size() && !slots.contains({p, s}))
        ++other_uses[m];
  std::optional<std::uint32_t> plain;
  std::map<std::uint32_t, std::uint32_t> copies;
  for (const auto& [p, s] : slots) {
    Part& part = scene.parts[p];
    if (s >= part.materials.size()) {
      if (s > 0 || !add_materials) continue;
      if (!plain) {
        plain = static_cast<std::uint32_t>(scene.materials.size());
        scene.materials.emplace_back().double_sided = true;
      }
      part.materials.push_back(*plain);
      continue;
    }
    std::uint32_t& material = part.materials[s];
    if (material >= other_uses.size() || scene.materials[material].double_sided) continue;
    if (other_uses[material] > 0) {
      const auto [copy, is_new] = copies.try_emplace(material, static_cast<std::uint32_t>(scene.materials.size()));
      if (is_new) scene.materials.push_back(Material(scene.materials[material]));
      material = copy->second;
    }
    scene.materials[material].double_sided = true;
  }
}

SceneSides find_sides(const Scene& scene, const SceneSideOptions& options, std::span<const Volume> view) {
  SceneSides found;
  if (options.keep) return found;
  if (options.deadline.passed()) {
    found.skipped = "the time limit left no time for it";
    return found;
  }
  const auto make = [&] { return make_sides(scene, options, view); };
  if (options.cache == nullptr) return make();
  std::vector<SeenPart> parts;
  for (const Part& part : scene.parts) parts.push_back(seen_part(part));
  std::vector<std::string> blending;
  for (const Material& material : scene.materials) blending.push_back(material.alpha_mode);
  // Found at once or not at all: the deadline cuts nothing short.
  auto [sides, was_there] = remembered(options.cache, "sides", CacheUse::read_write, make, parts, blending, scene.nodes,
                                       scene.roots, scene.up, options, std::vector<Volume>(view.begin(), view.end()));
  if (was_there) sides.seconds = 0;
  return std::move(sides);
}

SceneSides turn_sheets(Scene& scene, const SceneSideOptions& options, std::span<const Volume> view) {
  SceneSides found = find_sides(scene, options, view);
  std::set<PartSlot> ambiguous;
  for (const PartSheets& part : found.sheets) {
    add_ambiguous(scene, part, ambiguous);
    if (!part.turn.empty()) turn_triangles(scene.parts[part.part].mesh, part.turn);
  }
  show_both_sides(scene, ambiguous, options.add_materials);
  return found;
}

void leave_sheets(SceneSides& sides, std::size_t number, const std::vector<std::uint8_t>& flags) {
  PartSides& summary = sides.parts[number];
  PartSheets& part = sides.sheets[number];
  for (const SheetSide& sheet : part.sheets) {
    if (std::any_of(sheet.triangles.begin(), sheet.triangles.end(), [&](Index t) { return flags[t] != 0; })) continue;
    summary.left_facing_away += sheet.faces_away;
    summary.left_ambiguous += sheet.is_ambiguous();
    if (!part.turn.empty())
      for (const Index t : sheet.triangles) part.turn[t] = 0;
  }
  summary.turned_triangles = static_cast<std::size_t>(std::count(part.turn.begin(), part.turn.end(), 1));
  if (summary.turned_triangles == 0) part.turn.clear();
}

}  // namespace papilla
