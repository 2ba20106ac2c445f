// SPDX-License-Identifier: MIT
#include "papilla/pipeline/bake_plan.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "papilla/core/error.hpp"
#include "papilla/io/node_places.hpp"
#include "papilla/meshing/mesh_assembly.hpp"
#include "papilla/meshing/orient.hpp"
#include "papilla/meshing/statistics.hpp"
#include "papilla/meshing/weld.hpp"
#include "papilla/param/measure.hpp"
#include "papilla/pipeline/simplify_scene.hpp"

namespace papilla {
namespace {

/// A uv is taken as usable when at most this share of the surface's area has no or a degenerate image: a few bad
/// triangles are hidden by grain, more of them are not. Mirrored ones are as good as others: over a fold in uv grain
/// goes on as in a mirror.
constexpr double k_bad_uv_share = 0.02;
/// Below this σ2/σ1 of the area-weighted mean Jacobian, grain would look smeared: the uv served another purpose.
constexpr double k_worst_mean_stretch = 0.2;

/// Share of the area of the uv that is covered more than once.
/// @pre they have finite uv.
double overlap_of_uv(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles) {
  const TriangleMesh surface = extract_triangles(mesh, triangles);
  return measure_distortion(surface, surface.uv, {}).overlap_area_fraction;
}

struct UvJudgement {
  UvState state = UvState::absent;
  double mm_per_unit = 0;
  UvDefects defects;
  std::string note;
};

std::string percent(double share, const char* what) { return fmt::format("{:.3g} % {}", 100 * share, what); }

UvJudgement judge_uv(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles) {
  const bool any =
      std::any_of(triangles.begin(), triangles.end(), [&](std::uint32_t t) { return mesh.uv.has_value(t); });
  if (!any) return {UvState::absent, 0, {}, "no uv"};
  double area_3d = 0, area_uv = 0, mirrored = 0, bad = 0, stretched = 0;
  std::vector<std::uint32_t> finite;
  for (const std::uint32_t t : triangles) {
    const Vec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1) - a, c = mesh.corner(t, 2) - a;
    const double area = 0.5 * norm(cross(b, c));
    if (!(area > 0)) continue;
    area_3d += area;
    if (!mesh.uv.has_value(t)) {
      bad += area;
      continue;
    }
    const Triangle& corners = mesh.uv.indices[t];
    const Vec2 u = mesh.uv.values[corners[0]], v = mesh.uv.values[corners[1]] - u, w = mesh.uv.values[corners[2]] - u;
    const double doubled = cross(v, w);
    if (!std::isfinite(doubled) || doubled == 0) {
      bad += area;
      continue;
    }
    finite.push_back(t);
    if (doubled < 0) mirrored += area;
    area_uv += 0.5 * std::abs(doubled);
    // Singular values of the 3D -> uv map from its first fundamental form.
    const double length = norm(b);
    const double x = dot(b, c) / length, y = 2 * area / length;
    const Vec2 du = (1 / length) * v, dv = (1 / y) * (w - x * du);
    const double trace = dot(du, du) + dot(dv, dv), det = std::abs(cross(du, dv));
    const double root = std::sqrt(std::max(0.0, 0.25 * trace * trace - det * det));
    const double largest = 0.5 * trace + root;
    if (largest > 0 && det / largest < k_worst_mean_stretch) stretched += area;
  }
  if (!(area_3d > 0)) return {UvState::absent, 0, {}, "the surface has no area"};
  if (area_uv <= 0) return {UvState::absent, 0, {}, "its uv has no area"};
  const double mm_per_unit = std::sqrt((area_3d - bad > 0 ? area_3d - bad : area_3d) / area_uv);
  UvDefects defects{mirrored / area_3d, bad / area_3d, overlap_of_uv(mesh, finite)};
  const std::string numbers =
      fmt::format("{:.4g} mm per unit of its uv, {}, {}, {}", mm_per_unit, percent(defects.flipped, "flipped"),
                  percent(defects.degenerate, "degenerate"), percent(defects.overlapping, "overlapping"));
  if (defects.degenerate > k_bad_uv_share)
    return {UvState::unusable, mm_per_unit, defects, numbers + ": too much has no or a degenerate uv"};
  if (stretched > 0.5 * area_3d)
    return {UvState::unusable, mm_per_unit, defects,
            numbers + fmt::format(": {:.0f} % of its area is stretched by more than 5:1", 100 * stretched / area_3d)};
  return {UvState::usable, mm_per_unit, defects, numbers};
}

UvWish uv_wish(const std::string& unwrap) {
  if (unwrap == "auto") return UvWish::automatic;
  return unwrap == "keep" ? UvWish::keep : UvWish::renew;
}

/// The pictures on channel 0, which new uv take.
std::vector<std::string> pictures_on_own_uv(const Scene& scene, const PartSurface& surface) {
  std::vector<std::string> pictures;
  const std::vector<std::uint32_t>& materials = scene.parts[surface.part].materials;
  if (surface.slot >= materials.size()) return pictures;
  const Material& material = scene.materials[materials[surface.slot]];
  const auto add = [&](const std::optional<TextureReference>& reference, const char* what) {
    if (reference && reference->tex_coord == 0) pictures.emplace_back(what);
  };
  add(material.base_color_texture, "base colour picture");
  add(material.metallic_roughness_texture, "metallic-roughness picture");
  add(material.occlusion_texture, "occlusion picture");
  add(material.emissive_texture, "emissive picture");
  add(material.normal_texture, "normal map");
  return pictures;
}

/// Whether repair() has nothing to mend: a manifold without defects, oriented outward. Borders of meshes that were not
/// tessellated here may be gaps.
bool is_clean(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles, bool cad) {
  const MeshStatistics s = mesh_statistics(weld_equal(extract_triangles(mesh, triangles)).mesh);
  return s.nonmanifold_edges == 0 && s.degenerate_triangles == 0 && s.duplicate_triangles == 0 &&
         s.flipped_edges == 0 && s.t_junctions == 0 && s.volume_mm3.value_or(1) > 0 && (cad || s.boundary_edges == 0);
}

bool is_double_sided(const Scene& scene, const PartSurface& surface) {
  const std::vector<std::uint32_t>& materials = scene.parts[surface.part].materials;
  return surface.slot < materials.size() && scene.materials[materials[surface.slot]].double_sided;
}

bool has_relief(const PartSurface& surface) { return decision(surface.plan, Stage::height).run; }

/// Coarser levels face as the finest does: those of parts that were turned as a whole are turned as a whole, unless
/// they are levels of others, too. Those with the relief of a finest one that becomes double sided become so.
/// @param turned Parts that were turned as a whole.
void adjust_levels(const std::set<std::uint32_t>& turned, Scene& scene, BakePlan& plan) {
  std::map<std::uint32_t, std::set<std::uint32_t>> finest_of;
  for (const GltfOrigin::Level& level : plan.levels)
    finest_of[level.part].insert(scene.nodes[level.finest].part.value());
  std::set<std::pair<std::uint32_t, std::string>> double_sided;  // Part and material.
  for (const PartSurface& surface : plan.surfaces)
    if (surface.becomes_double_sided) double_sided.emplace(surface.part, surface.material);
  std::set<std::uint32_t> turned_levels;
  for (PartSurface& surface : plan.surfaces) {
    const auto finest = finest_of.find(surface.part);
    if (finest == finest_of.end()) continue;
    const auto& parts = finest->second;
    if (has_relief(surface) && std::any_of(parts.begin(), parts.end(), [&](std::uint32_t part) {
          return double_sided.contains({part, surface.material});
        }))
      surface.becomes_double_sided = !is_double_sided(scene, surface);
    if (!std::includes(turned.begin(), turned.end(), parts.begin(), parts.end())) continue;
    surface.turned.assign(surface.triangles.size(), 1);
    turned_levels.insert(surface.part);
  }
  for (const std::uint32_t part : turned_levels) {
    TriangleMesh& mesh = scene.parts[part].mesh;
    turn_triangles(mesh, std::vector<std::uint8_t>(mesh.triangles.size(), 1));
  }
}

/// Turns the sheets over of which some has relief; they are turned as a whole, whatever shares them.
void turn_sheets_with_relief(Scene& scene, BakePlan& plan) {
  std::set<std::uint32_t> turned;
  for (std::size_t i = 0; i < plan.sides.sheets.size(); ++i) {
    const PartSheets& part = plan.sides.sheets[i];
    TriangleMesh& mesh = scene.parts[part.part].mesh;
    std::vector<std::uint8_t> relief(mesh.triangles.size(), 0), ambiguous(mesh.triangles.size(), 0);
    for (const PartSurface& surface : plan.surfaces)
      if (surface.part == part.part && has_relief(surface))
        for (const std::uint32_t t : surface.triangles) relief[t] = 1;
    leave_sheets(plan.sides, i, relief);
    for (const SheetSide& sheet : part.sheets)
      if (sheet.is_ambiguous())
        for (const Index t : sheet.triangles) ambiguous[t] = 1;
    for (PartSurface& surface : plan.surfaces) {
      if (surface.part != part.part) continue;
      const auto any = [&](const std::vector<std::uint8_t>& flags) {
        return std::any_of(surface.triangles.begin(), surface.triangles.end(),
                           [&](std::uint32_t t) { return flags[t] != 0; });
      };
      if (has_relief(surface) && any(ambiguous)) surface.becomes_double_sided = !is_double_sided(scene, surface);
      if (part.turn.empty() || !any(part.turn)) continue;
      for (const std::uint32_t t : surface.triangles) surface.turned.push_back(part.turn[t]);
    }
    if (part.turn.empty()) continue;
    turn_triangles(mesh, part.turn);
    if (std::find(part.turn.begin(), part.turn.end(), 0) == part.turn.end()) turned.insert(part.part);
  }
  adjust_levels(turned, scene, plan);
}

std::vector<PartSurface> split_by_slot(const Scene& scene, const Assignment& assignment) {
  std::vector<PartSurface> surfaces;
  for (std::uint32_t p = 0; p < scene.parts.size(); ++p) {
    const Part& part = scene.parts[p];
    std::map<std::uint32_t, std::vector<std::uint32_t>> by_slot;
    for (std::uint32_t t = 0; t < part.mesh.triangles.size(); ++t)
      by_slot[part.mesh.material.empty() ? 0 : part.mesh.material[t]].push_back(t);
    for (auto& [slot, triangles] : by_slot) {
      PartSurface surface;
      surface.part = p;
      surface.slot = slot;
      surface.triangles = std::move(triangles);
      surface.label = assignment.parts[p].is_split ? part.id : shown_name(part);
      if (by_slot.size() > 1)
        surface.label +=
            "/" + (slot < part.materials.size() ? scene.materials[part.materials[slot]].name : std::to_string(slot));
      surfaces.push_back(std::move(surface));
    }
  }
  return surfaces;
}

/// What the rules took, and warnings of those that took nothing. @param source What messages begin with.
void note_rules(const Assignment& assignment, bool strict, const std::string& source, Scene& scene, BakePlan& plan) {
  std::vector<std::string> problems = problems_of(assignment.uses, "rule", "/assign");
  for (std::string& problem : problems_of(plan.object_textures.decal_uses, "decal", "/decals"))
    problems.push_back(std::move(problem));
  for (std::string& problem : problems_of(plan.object_textures.carrier_uses, "carrier", "/replace"))
    problems.push_back(std::move(problem));
  if (strict && !problems.empty())
    throw InvalidInput(fmt::format("{}: {}{}", source, problems.front(),
                                   problems.size() > 1 ? fmt::format("; {} more rules", problems.size() - 1) : ""));
  scene.warnings.insert(scene.warnings.end(), problems.begin(), problems.end());
  plan.rules = assignment.uses;
  plan.split = assignment.split;
}

}  // namespace

std::set<std::string> grains_of(const std::vector<PartSurface>& surfaces) {
  std::set<std::string> names;
  for (const PartSurface& surface : surfaces)
    if (has_relief(surface)) names.insert(surface.material);
  return names;
}

std::vector<PartSurface> plan_surfaces(const Scene& scene, const Assignment& assignment,
                                       const std::vector<PartPerception>& perception, bool in_place) {
  std::vector<PartSurface> surfaces = split_by_slot(scene, assignment);
  const bool cad = scene.format == "STEP" || scene.format == "IGES" || scene.format == "BREP";
  for (PartSurface& surface : surfaces) {
    const Part& part = scene.parts[surface.part];
    const MaterialRule* rule = assignment.parts[surface.part].rule_of(surface.slot);
    if (rule) surface.material = rule->name;
    const bool grain = rule && !rule->texture.empty();
    const UvJudgement uv = grain ? judge_uv(part.mesh, surface.triangles) : UvJudgement{};
    surface.uv_mm_per_unit = uv.mm_per_unit;
    surface.uv_defects = uv.defects;
    surface.uv_note = uv.note;
    const bool feel = grain || (rule && (rule->stiffness || rule->static_friction || rule->dynamic_friction ||
                                         rule->damping || rule->friction_model || rule->force_model || rule->backing));
    Given given{cad, uv.state};
    given.in_place = in_place;
    if (!perception.empty()) {
      given.left_out = perception[surface.part].left_out;
      given.is_only_seen = perception[surface.part].is_only_seen;
    }
    const Wanted wanted{grain, feel, grain ? uv_wish(rule->unwrap) : UvWish::automatic};
    if (stage_rules::repair(wanted, given).run) given.is_clean = is_clean(part.mesh, surface.triangles, cad);
    surface.is_left_out = !given.left_out.empty();
    surface.plan = make_plan(wanted, given);
    if (!in_place && decision(surface.plan, Stage::unwrap).run) surface.lost = pictures_on_own_uv(scene, surface);
  }
  return surfaces;
}

BakePlan plan_bake(Scene scene, const Materials& rules, const BakePlanOptions& options,
                   const ProgressCallback& progress) {
  BakePlan plan;
  // Before sheets are turned, which gives some a material that no rule means.
  plan.levels = options.levels;
  plan.object_textures = find_object_textures(scene, rules);
  Assignment assignment = assign_materials(scene, rules, plan.levels);
  note_rules(assignment, options.strict, rules.source, scene, plan);
  plan.sides = options.in_place ? find_sides(scene, options.sides, options.perception.view)
                                : turn_sheets(scene, options.sides, options.perception.view);
  if (!options.in_place && !options.keep_copies) plan.shared = share_identical_parts(scene, assignment);
  const Stopwatch perception_clock;
  plan.perception = measure_perception(scene, options.perception, progress);
  plan.perception_seconds = perception_clock.seconds();
  const Stopwatch simplify_clock;
  if (options.budget) {
    Scene drawn = scene;
    leave_out(drawn, plan.perception);
    SimplifyOptions simplify;
    simplify.deadline = options.deadline;
    simplify.progress = progress;
    plan.budget = fit_scene_to_budget(drawn, *options.budget, simplify);
    for (std::size_t i = 0; i < scene.parts.size(); ++i)
      if (plan.perception.parts[i].left_out.empty()) scene.parts[i].mesh = plan.budget->parts[i].mesh;
    for (SimplifyResult& part : plan.budget->parts) {
      plan.budget_triangles.push_back(part.mesh.triangles.size());
      part.mesh = {};
    }
  }
  plan.simplify_seconds = simplify_clock.seconds();
  plan.surfaces = plan_surfaces(scene, assignment, plan.perception.parts, options.in_place);
  if (options.in_place) turn_sheets_with_relief(scene, plan);
  plan.scene = std::move(scene);
  return plan;
}

}  // namespace papilla
