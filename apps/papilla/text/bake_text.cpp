// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "papilla/core/units.hpp"
#include "papilla/haptic/stimulus.hpp"
#include "papilla/io/node_places.hpp"
#include "shown_format.hpp"
#include "text/scene_text.hpp"

namespace papilla::app {

std::string way_line(const BakeWay& way) {
  return shown_format("{}: {}\n", way.in_place ? "edited in place" : "written anew", way.reason);
}

std::string changes_line(const std::vector<GltfChange>& changes) {
  if (changes.empty()) return "";
  std::map<std::string, std::size_t> count;
  for (const GltfChange& change : changes) ++count[change.kind];
  return shown_format("members of the document: {} added, {} changed, {} removed; all else is as it was\n",
                      count["added"], count["changed"], count["removed"]);
}

std::string plan_table(const std::vector<PartSurface>& surfaces) {
  std::size_t width = 4, material_width = 8;
  for (const PartSurface& surface : surfaces) {
    width = std::clamp(surface.label.size(), width, std::size_t{64});
    material_width = std::clamp(surface.material.size(), material_width, std::size_t{24});
  }
  std::string out =
      shown_format("{:<{}}  {:<{}}  {:>9}  stages\n", "part", width, "material", material_width, "triangles");
  for (const PartSurface& surface : surfaces) {
    std::string stages;
    std::map<std::string_view, std::string> skipped;
    for (std::size_t i = 0; i < k_stage_count; ++i) {
      if (surface.plan[i].run) {
        stages += (stages.empty() ? "" : " ") + std::string(k_stages[i].name);
        continue;
      }
      std::string& names = skipped[surface.plan[i].reason];
      names += (names.empty() ? "" : ", ") + std::string(k_stages[i].name);
    }
    out += shown_format("{:<{}}  {:<{}}  {:>9}  {}\n", surface.label, width,
                        surface.material.empty() ? "-" : surface.material, material_width, surface.triangles.size(),
                        stages.empty() ? "nothing to do" : stages);
    for (const auto& [reason, names] : skipped)
      out += shown_format("{:<{}}  without {}: {}\n", "", width, names, reason);
    if (!surface.uv_note.empty()) out += shown_format("{:<{}}  own uv: {}\n", "", width, surface.uv_note);
    for (const std::string& picture : surface.lost)
      out += shown_format("{:<{}}  lost with new uv: {}\n", "", width, picture);
  }
  return out;
}

std::string left_out_table(const Scene& scene, const ScenePerception& perception) {
  std::string table;
  for (std::size_t p = 0; p < perception.parts.size(); ++p) {
    const PartPerception& part = perception.parts[p];
    if (part.instances_left_out == 0) continue;
    const std::string uses = part.instances_left_out == part.instances
                                 ? ""
                                 : shown_format(" ({} of {} uses)", part.instances_left_out, part.instances);
    std::string_view reason = part.left_out;
    for (std::size_t i = 0; reason.empty() && i < perception.uses.size(); ++i)
      if (perception.uses[i].part == p) reason = perception.of_use[i].left_out;
    table += shown_format("left out: {}{}: {}\n", shown_name(scene.parts[p]), uses, reason);
  }
  return table;
}

namespace {

/// Empty when nothing of the relief was too steep.
std::string slope_line(const std::string& material, const GrainHeight& height) {
  const SlopeLimitResult& slopes = height.slopes;
  if (slopes.share_before == 0) return "";
  return shown_format(
      "{}: slopes limited to {:.3g}: {:.3g} % of the relief was steeper, up to {:.3g}; now {:.3g} %; {:.3g} mm high "
      "instead of {:.3g}\n",
      material, height.max_slope, 100 * slopes.share_before, slopes.steepest_before, 100 * slopes.share_after,
      height.depth_mm, height.unlimited_depth_mm);
}

/// What became of the surfaces when none has grain.
std::string surfaces_without_grain(const std::vector<PartSurface>& surfaces) {
  const auto count = [&](auto&& is_so) {
    return static_cast<std::size_t>(std::count_if(surfaces.begin(), surfaces.end(), is_so));
  };
  const std::size_t assigned = count([](const PartSurface& s) { return !s.material.empty(); });
  const std::size_t felt = count([](const PartSurface& s) { return decision(s.plan, Stage::tag).run; });
  if (assigned == 0) return "no rule took a surface: none gets a material\n";
  return shown_format("no surface gets grain; {} of {} get constants of touch\n", felt, surfaces.size());
}

}  // namespace

std::string grains_text(const std::vector<GrainPlan>& grains) {
  std::string out;
  for (const GrainPlan& grain : grains) {
    if (!grain.problem.empty()) out += shown_format("grain {}: can't be made: {}\n", grain.material, grain.problem);
    if (grain.steps.empty() || !grain.problem.empty()) continue;
    out += shown_format("\ngrain {}\n", grain.material);
    for (const PlanStep& step : grain.steps)
      out += shown_format("  {} {:<20}  {}\n", step.run ? "+" : "-", step.step, step.reason);
  }
  return out;
}

std::string contact_models_text(const Materials& rules, const std::vector<PartSurface>& surfaces) {
  std::set<std::string> used;
  for (const PartSurface& surface : surfaces) used.insert(surface.material);
  std::string out;
  for (const auto& [name, rule] : rules.materials) {
    if (!used.contains(name)) continue;
    std::string models;
    if (const auto& m = rule.force_model) {
      const ForceModel model = force_model(m->name).value_or(ForceModel::heightfield);
      models = "force model " + m->name;
      if (!m->form.empty()) models += ", " + m->form;
      if (is_stimulus(model)) models += shown_format(", {:g} N per grey level", m->amplitude);
      if (m->literal) models += ", uphill";
      if (is_graph(model)) models += shown_format(", level {}", m->level);
    }
    if (const auto& m = rule.friction_model) {
      models += (models.empty() ? "friction model " : "; friction model ") + m->name;
      if (m->stiffness > 0) models += shown_format(", {:g} N/m", m->stiffness);
    }
    const auto add = [&models](const std::string& what) { models += (models.empty() ? "" : "; ") + what; };
    if (const auto& backing = rule.backing)
      add(shown_format("backing {:g} N/m from {:g} mm on", backing->stiffness, k_mm_per_metre * backing->depth_m));
    for (const auto& [quantity, map] : rule.maps)
      add(shown_format("map of {} {}, {:g} to {:g} times", map_key(quantity), map.recipe, map.range[0], map.range[1]));
    if (!models.empty()) out += shown_format("{}: {}\n", name, models);
  }
  return out;
}

std::string rules_table(const std::vector<RuleUse>& uses, const Materials& rules) {
  if (uses.empty()) return "no rules: 'assign' is empty\n";
  std::size_t width = 8;
  for (const AssignRule& rule : rules.assign) width = std::clamp(rule.material.size(), width, std::size_t{24});
  std::string out = shown_format("\nrule  {:<{}}  {:>8}  {:>8}  for\n", "material", width, "surfaces", "uses");
  for (std::size_t i = 0; i < uses.size(); ++i) {
    const std::string& material = rules.assign.at(i).material;
    out += shown_format("{:>4}  {:<{}}  {:>8}  {:>8}  {}\n", i + 1, material.empty() ? "-" : material, width,
                        uses[i].surfaces, uses[i].uses, uses[i].selector);
  }
  return out;
}

std::string bake_table(const BakeResult& result) {
  constexpr std::size_t k_listed = 200;
  std::size_t width = 4, material_width = 8;
  for (const BakedSurface& surface : result.surfaces) {
    width = std::clamp(surface.label.size(), width, std::size_t{64});
    material_width = std::clamp(surface.material.size(), material_width, std::size_t{24});
  }
  std::string out =
      shown_format("{:<{}}  {:<{}}  {:<12}  {:>6}  {:>9}  {:>7}  {:>6}  {:>7}\n", "part", width, "material",
                   material_width, "unwrap", "charts", "triangles", "sym.D", "angle°", "flipped");
  for (std::size_t i = 0; i < std::min(result.surfaces.size(), k_listed); ++i) {
    const BakedSurface& surface = result.surfaces[i];
    out += shown_format("{:<{}}  {:<{}}  {:<12}  {:>6}  {:>9}  {:>7.3f}  {:>6.2f}  {:>7}\n", surface.label, width,
                        surface.material, material_width, surface.method, surface.distortion.charts,
                        surface.distortion.triangles, surface.distortion.symmetric_dirichlet.mean,
                        surface.distortion.angle_error_deg.mean, surface.distortion.flipped);
    if (!surface.notes.empty())
      out += shown_format("{:<{}}  {} of its charts fell back: {}\n", "", width, surface.notes.size(),
                          surface.notes.front());
  }
  if (result.surfaces.size() > k_listed)
    out += shown_format("and {} surfaces more: --json lists all\n", result.surfaces.size() - k_listed);
  for (const auto& [name, grain] : result.grains) out += slope_line(name, grain.height);
  out += repair_numbers_text(repair_of(result.surfaces));
  if (result.surfaces.empty()) out = surfaces_without_grain(result.plan.surfaces);
  return out + ending_line(ending_of(result));
}

}  // namespace papilla::app
