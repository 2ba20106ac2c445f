// SPDX-License-Identifier: MIT
#include "papilla/pipeline/scene_sides.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/io/node_places.hpp"
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

/// Makes materials double sided where a part has a sheet without side.
class DoubleSides {
 public:
  DoubleSides(Scene& scene, bool add_materials) : scene_(scene), add_materials_(add_materials) {}

  void add(std::uint32_t part, const MeshSheets& mesh) {
    for (const SheetSide& sheet : mesh.sheets)
      if (sheet.is_ambiguous())
        for (const Index t : sheet.triangles)
          slots_.emplace(part, mesh.mesh->material.empty() ? 0 : mesh.mesh->material[t]);
  }

  void apply() {
    std::vector<std::size_t> other_uses(scene_.materials.size(), 0);
    for (std::uint32_t p = 0; p < scene_.parts.size(); ++p)
      for (std::uint32_t s = 0; s < scene_.parts[p].materials.size(); ++s)
        if (const std::uint32_t m = scene_.parts[p].materials[s]; m < other_uses.size() && !slots_.contains({p, s}))
          ++other_uses[m];
    std::map<std::uint32_t, std::uint32_t> copies;
    for (const auto& [p, s] : slots_) {
      Part& part = scene_.parts[p];
      if (s >= part.materials.size()) {
        if (s == 0 && add_materials_) part.materials.push_back(plain_material());
        continue;
      }
      std::uint32_t& material = part.materials[s];
      if (material >= other_uses.size() || scene_.materials[material].double_sided) continue;
      if (other_uses[material] > 0) {
        const auto [copy, is_new] = copies.try_emplace(material, static_cast<std::uint32_t>(scene_.materials.size()));
        if (is_new) scene_.materials.push_back(Material(scene_.materials[material]));
        material = copy->second;
      }
      scene_.materials[material].double_sided = true;
    }
  }

 private:
  std::uint32_t plain_material() {
    if (!plain_) {
      plain_ = static_cast<std::uint32_t>(scene_.materials.size());
      scene_.materials.emplace_back().double_sided = true;
    }
    return *plain_;
  }

  Scene& scene_;
  bool add_materials_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> slots_;  ///< Part and slot.
  std::optional<std::uint32_t> plain_;
};

}  // namespace

SceneSides find_sides(const Scene& scene, const SceneSideOptions& options, std::span<const Volume> view) {
  return find(scene, options, view).summary;
}

SceneSides turn_sheets(Scene& scene, const SceneSideOptions& options, std::span<const Volume> view) {
  FoundSides found = find(scene, options, view);
  DoubleSides double_sides(scene, options.add_materials);
  for (const auto& [part, mesh] : found.parts) {
    double_sides.add(part, mesh);
    if (!mesh.turn.empty()) turn_triangles(scene.parts[part].mesh, mesh.turn);
  }
  double_sides.apply();
  return std::move(found.summary);
}

}  // namespace papilla
