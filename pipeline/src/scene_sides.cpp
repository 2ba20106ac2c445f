// SPDX-License-Identifier: MIT
#include "papilla/pipeline/scene_sides.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/meshing/orient.hpp"
#include "placed_meshes.hpp"

namespace papilla {
namespace {

struct FoundSides {
  SceneSides summary;
  std::vector<std::pair<std::uint32_t, MeshSheets>> parts;  ///< Parts with sheets, ascending.
};

PartSides summary_of(const Part& part, const MeshSheets& mesh) {
  PartSides sides;
  sides.part = part.name;
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

FoundSides find(const Scene& scene, const SceneSideOptions& options, std::span<const Volume> view) {
  FoundSides found;
  if (options.keep) return found;
  const Stopwatch clock;
  const std::vector<PlacedMesh> uses = placed_meshes(scene, instances(scene));
  SheetSides sides;
  try {
    sides = find_sheet_sides(uses, {options.inside, {view.begin(), view.end()}});
  } catch (const InvalidInput& error) {
    found.summary.skipped = error.what();
    return found;
  }
  std::unordered_map<const TriangleMesh*, MeshSheets*> of_mesh;
  for (MeshSheets& mesh : sides.meshes)
    if (!mesh.sheets.empty()) of_mesh.emplace(mesh.mesh, &mesh);
  SceneSides& summary = found.summary;
  summary.viewpoint = sides.viewpoint;
  summary.eye = sides.eye;
  summary.enclosure = sides.enclosure;
  for (std::uint32_t p = 0; p < scene.parts.size(); ++p) {
    const auto mesh = of_mesh.find(&scene.parts[p].mesh);
    if (mesh == of_mesh.end()) continue;
    summary.parts.push_back(summary_of(scene.parts[p], *mesh->second));
    summary.open_components += summary.parts.back().open_components;
    summary.facing_away += summary.parts.back().facing_away;
    summary.ambiguous += summary.parts.back().ambiguous;
    found.parts.emplace_back(p, std::move(*mesh->second));
  }
  summary.seconds = clock.seconds();
  return found;
}

void add_ambiguous(std::uint32_t part, const MeshSheets& mesh, std::set<PartSlot>& slots) {
  for (const SheetSide& sheet : mesh.sheets)
    if (sheet.is_ambiguous())
      for (const Index t : sheet.triangles)
        slots.emplace(part, mesh.mesh->material.empty() ? 0 : mesh.mesh->material[t]);
}

}  // namespace

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
  return find(scene, options, view).summary;
}

SceneSides turn_sheets(Scene& scene, const SceneSideOptions& options, std::span<const Volume> view) {
  FoundSides found = find(scene, options, view);
  std::set<PartSlot> ambiguous;
  for (const auto& [part, mesh] : found.parts) {
    add_ambiguous(part, mesh, ambiguous);
    if (!mesh.turn.empty()) turn_triangles(scene.parts[part].mesh, mesh.turn);
  }
  show_both_sides(scene, ambiguous, options.add_materials);
  return std::move(found.summary);
}

}  // namespace papilla
