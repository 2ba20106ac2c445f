// SPDX-License-Identifier: GPL-3.0-or-later
#include "json/scene_json.hpp"
#include "json/texture_json.hpp"
#include "papilla/core/units.hpp"

namespace papilla::app {
namespace {

/// What limiting the slopes did, and its error (largest slope over the limit, less 1) over run time.
Json slope_json(const GrainHeight& height) {
  const SlopeLimitResult& slopes = height.slopes;
  Json json = {{"max_slope", height.max_slope},
               {"steepest", {{"before", slopes.steepest_before}, {"after", slopes.steepest_after}}},
               {"steeper_share", {{"before", slopes.share_before}, {"after", slopes.share_after}}},
               {"depth_mm", {{"before", height.unlimited_depth_mm}, {"after", height.depth_mm}}},
               {"rms_change_mm", slopes.rms_change_mm},
               {"largest_change_mm", slopes.largest_change_mm},
               {"iterations", slopes.iterations},
               {"stop", to_string(slopes.stop)},
               {"trace", Json::array()}};
  for (const TraceSample& sample : slopes.trace)
    json["trace"].push_back({{"seconds", sample.seconds}, {"error", sample.error}});
  return json;
}

/// What the channels of a tag's maps are, from where to where, in SI units.
Json channels_json(const std::optional<MapsTag>& maps) {
  Json json = Json::array();
  if (!maps) return json;
  for (const auto& channel : maps->channels)
    if (channel)
      json.push_back(
          {{"quantity", name_of(channel->quantity)}, {"least", channel->least()}, {"most", channel->most()}});
  return json;
}

Json total_json(const std::vector<BakedSurface>& surfaces) {
  std::vector<const DistortionReport*> reports;
  for (const BakedSurface& surface : surfaces) reports.push_back(&surface.distortion);
  const DistortionTotals total = total_distortion(reports);
  Json json = {{"triangles", total.triangles},
               {"charts", total.charts},
               {"flipped", total.flipped},
               {"overlapping_within_charts", total.overlapping_within_charts},
               {"area_mm2", total.area_mm2}};
  if (!total.has_overlap) json.erase("overlapping_within_charts");
  if (!(total.area_mm2 > 0)) return json;
  json["symmetric_dirichlet"] = {{"mean", total.symmetric_dirichlet_mean}};
  json["angle_error_deg"] = {{"mean", total.angle_error_deg_mean}};
  json["stretch_l2"] = total.stretch_l2;
  json["stretch_linf"] = total.stretch_linf;
  return json;
}

}  // namespace

Json grain_json(const std::string& name, const Grain& grain) {
  const GrainHeight& h = grain.height;
  Json height = {{"method", h.method}, {"reason", h.reason}};
  if (h.light) {
    height["light"] = {h.light->x, h.light->y, h.light->z};
    height["light_estimated"] = h.light_estimated;
  }
  height.update({{"depth_mm", h.depth_mm}, {"rms_mm", h.rms_mm}, {"periodic", grain.relief.periodic}});
  if (h.light) height["stop"] = to_string(h.stop);
  if (h.stereo) {
    height["photographs"] = h.photographs;
    height["light_estimated"] = h.light_estimated;
    height.update(stereo_readings_json(*h.stereo));
  }
  height["slope"] = slope_json(h);
  Json json = {{"name", name},
               {"picture",
                {{"file", grain.source},
                 {"width", grain.photograph.width},
                 {"height", grain.photograph.height},
                 {"size_mm", {grain.size_mm[0], grain.size_mm[1]}},
                 {"shows_mm", {grain.photograph_mm.x, grain.photograph_mm.y}},
                 {"tiles", grain.tiles},
                 {"monochrome", grain.monochrome},
                 {"shown", grain.picture.has_value()}}},
               {"class",
                {{"name", to_string(grain.kind.kind)},
                 {"disordered", grain.kind.disordered},
                 {"weakly_ordered", grain.kind.weakly_ordered},
                 {"strongly_ordered", grain.kind.strongly_ordered}}},
               {"lattice", grain.lattice.has_value()}};
  if (grain.lattice) {
    json["group"] = grain.lattice->group;
    json["period_mm"] = Json::array();
    for (const Vec2& period : grain.lattice->period_mm) json["period_mm"].push_back({period.x, period.y});
  }
  json["height"] = height;
  const auto& fractal = grain.roughness.fractal;
  json["roughness"] = {{"rms_mm", grain.roughness.rms_mm},
                       {"fractal_dimension", fractal ? Json(fractal->dimension) : Json(nullptr)},
                       {"overlay", roughness_model_json(h.overlay)}};
  json["maps"] = channels_json(grain.tag.maps);
  json["plan"] = steps_json(grain.plan);
  return json;
}

Json plan_json(const std::vector<PartSurface>& surfaces) {
  Json stages = Json::array();
  for (const PartSurface& surface : surfaces)
    for (std::size_t i = 0; i < k_stage_count; ++i)
      stages.push_back({{"part", surface.label},
                        {"material", surface.material.empty() ? Json(nullptr) : Json(surface.material)},
                        {"stage", k_stages[i].name},
                        {"run", surface.plan[i].run},
                        {"reason", surface.plan[i].reason}});
  return stages;
}

Json grain_plans_json(const std::vector<GrainPlan>& plans) {
  Json json = Json::array();
  for (const GrainPlan& plan : plans)
    json.push_back({{"material", plan.material},
                    {"steps", steps_json(plan.steps)},
                    {"problem", plan.problem.empty() ? Json(nullptr) : Json(plan.problem)}});
  return json;
}

Json own_uv_json(const std::vector<PartSurface>& surfaces) {
  Json json = Json::array();
  for (const PartSurface& surface : surfaces)
    if (!surface.uv_note.empty())
      json.push_back({{"part", surface.label},
                      {"material", surface.material},
                      {"mm_per_unit", surface.uv_mm_per_unit},
                      {"flipped", surface.uv_defects.flipped},
                      {"degenerate", surface.uv_defects.degenerate},
                      {"overlapping", surface.uv_defects.overlapping},
                      {"note", surface.uv_note},
                      {"lost", surface.lost}});
  return json;
}

Json contact_models_json(const Materials& rules) {
  Json json = Json::array();
  for (const auto& [name, rule] : rules.materials) {
    if (!rule.force_model && !rule.friction_model && !rule.backing && rule.maps.empty()) continue;
    Json line = {{"material", name},
                 {"force_model", nullptr},
                 {"friction_model", nullptr},
                 {"backing", nullptr},
                 {"maps", Json::object()}};
    if (const auto& backing = rule.backing)
      line["backing"] = {{"stiffness", backing->stiffness}, {"depth_mm", k_mm_per_metre * backing->depth_m}};
    for (const auto& [quantity, map] : rule.maps)
      line["maps"][std::string(map_key(quantity))] = {{"picture", map.recipe}, {"range", map.range}};
    if (const auto& m = rule.force_model)
      line["force_model"] = {{"name", m->name},
                             {"form", m->form.empty() ? Json() : Json(m->form)},
                             {"amplitude", m->amplitude},
                             {"sign", m->literal ? "literal" : "downhill"},
                             {"level", m->level}};
    if (const auto& m = rule.friction_model) line["friction_model"] = {{"name", m->name}, {"stiffness", m->stiffness}};
    json.push_back(std::move(line));
  }
  return json;
}

Json way_json(const BakeWay& way) { return {{"in_place", way.in_place}, {"reason", way.reason}}; }

Json changes_json(const std::vector<GltfChange>& changes) {
  Json json = Json::array();
  for (const GltfChange& change : changes) json.push_back({{"change", change.kind}, {"pointer", change.pointer}});
  return json;
}

Json rules_json(const std::vector<RuleUse>& uses) {
  Json rules = Json::array();
  for (const RuleUse& use : uses)
    rules.push_back({{"for", use.selector},
                     {"surfaces", use.surfaces},
                     {"uses", use.uses},
                     {"problem", use.problem.empty() ? Json(nullptr) : Json(use.problem)}});
  return rules;
}

Json bake_json(const BakeResult& result, const BakeOptions& options) {
  Json json;
  json["plan"] = plan_json(result.plan.surfaces);
  json["parts"] = Json::array();
  for (const BakedSurface& surface : result.surfaces)
    json["parts"].push_back({{"part", surface.label},
                             {"material", surface.material},
                             {"unwrap", surface.method},
                             {"reason", surface.reason},
                             {"stop", to_string(surface.stop)},
                             {"same_as", surface.same_as.empty() ? Json(nullptr) : Json(surface.same_as)},
                             {"charts", surface.charts},
                             {"seam_mm", surface.seam_mm},
                             {"grain_continued_mm", surface.grain_continued_mm},
                             {"seam_visibility", seams_json(surface.seams)},
                             {"notes", surface.notes},
                             {"repair", surface.repaired ? repair_numbers_json(*surface.repaired) : Json()},
                             {"distortion", distortion_json(surface.distortion)}});
  json["materials"] = Json::array();
  for (const auto& [name, grain] : result.grains) json["materials"].push_back(grain_json(name, grain));
  json["atlases"] = atlases_json(result.atlases);
  json["uv"] = own_uv_json(result.plan.surfaces);
  json["distortion"] = total_json(result.surfaces);
  json["repair"] = repair_numbers_json(repair_of(result.surfaces));
  json["stop"] = to_string(ending_of(result));
  json["sides"] = sides_json(result.plan.sides, options.plan.sides);
  json["object_textures"] = object_textures_json(result.object_textures, result.plan.object_textures);
  json["losses"] = result.scene.losses;
  json["warnings"] = result.scene.warnings;
  json["seconds"] = result.seconds;
  json["identical_parts"] = shared_parts_json(result.plan.shared, result.scene);
  if (options.plan.perception.asked()) json["perception"] = perception_json(result.scene, result.plan.perception);
  if (const auto& budget = result.plan.budget)
    json["budget"] =
        budget_json(result.scene, *options.plan.budget, *budget, budget->parts, result.plan.budget_triangles);
  return json;
}

Json atlases_json(const std::vector<BakedAtlas>& atlases) {
  Json json = Json::array();
  for (const BakedAtlas& atlas : atlases)
    json.push_back({{"material", atlas.material},
                    {"width", atlas.width},
                    {"height", atlas.height},
                    {"charts", atlas.charts},
                    {"mm_per_texel", atlas.mm_per_texel}});
  return json;
}

Json weather_json(const WeatheredMaterial& m) {
  Json json{{"name", m.name}, {"recipe", m.recipe}};
  if (m.recipe.empty()) return json;
  if (!m.skipped.empty()) {
    json["skipped"] = m.skipped;
    return json;
  }
  if (m.atlas)
    json["atlas"] = {{"width", m.atlas->width},   {"height", m.atlas->height},
                     {"charts", m.atlas->charts}, {"tiles_computed", m.atlas->tiles_computed},
                     {"tiles", m.atlas->tiles},   {"texels_per_repeat", m.atlas->texels_per_repeat}};
  json["depends_on"] = {{"normal", m.depends_on_normal},
                        {"position", m.depends_on_position},
                        {"sky", m.depends_on_sky},
                        {"neighbours", m.depends_on_neighbours}};
  json["uses"] = m.uses;
  json["own_relief"] = m.own_relief;
  json["keeps_relief"] = m.keeps_relief;
  json["mm_per_texel"] = m.mm_per_texel;
  json["friction"] = m.friction;
  json["stiffness"] = m.stiffness;
  json["damping"] = m.damping;
  json["roughness"] = m.roughness;
  json["metallic"] = m.metallic;
  json["alpha"] = m.alpha;
  json["maps"] = channels_json(m.maps);
  return json;
}

}  // namespace papilla::app
