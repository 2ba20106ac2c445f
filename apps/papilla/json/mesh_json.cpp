// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <map>
#include <set>

#include "json/scene_json.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/haptic/material_tag.hpp"
#include "papilla/io/node_places.hpp"
#include "papilla/pipeline/part_statistics.hpp"
#include "tags_json.hpp"

namespace papilla::app {
namespace {

std::string material_names(const Scene& scene, const Part& part) {
  const std::set<std::uint32_t> used(part.materials.begin(), part.materials.end());
  std::string names;
  for (const std::uint32_t m : used)
    if (m < scene.materials.size()) names += (names.empty() ? "" : ", ") + scene.materials[m].name;
  return names;
}

Json parts_json(const Scene& scene, const std::vector<MeshStatistics>& statistics) {
  const std::vector<std::size_t> uses = uses_of_parts(scene);
  Json parts = Json::array();
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const MeshStatistics& s = statistics[i];
    Json part{{"name", shown_name(scene.parts[i])}};
    part.update(counters_json(s));
    part["material"] = material_names(scene, scene.parts[i]);
    part["instances"] = uses[i];
    part["bbox_mm"] = {s.high.x - s.low.x, s.high.y - s.low.y, s.high.z - s.low.z};
    part["area_mm2"] = s.area_mm2;
    part["volume_mm3"] = or_null(s.volume_mm3);
    parts.push_back(std::move(part));
  }
  return parts;
}

Json materials_json(const Scene& scene) {
  Json materials = Json::array();
  for (const Material& m : scene.materials)
    materials.push_back({{"name", m.name},
                         {"base_color", m.base_color},
                         {"double_sided", m.double_sided},
                         {"textures", Json::object()},
                         {"haptic", m.haptic.has_value()}});
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    for (const auto& [use, name] : texture_names(scene, scene.materials[i])) materials[i]["textures"][use] = name;
  return materials;
}

/// The tag as it stands in the file; a height map within the tag is only named.
Json tag_json(const MaterialTag& tag) {
  MaterialTag shown = tag;
  for (PlacedPicture* picture : pictures_of(shown))
    if (picture->is_embedded()) picture->uri = "data:";
  return Json::parse(to_json(shown));
}

/// Every tagged material, and what became of tags that the file had before.
Json haptic_json(const Scene& scene) {
  const std::vector<std::size_t> triangles = triangles_of_materials(scene);
  Json tags = Json::array();
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    const Material& material = scene.materials[m];
    if (!material.haptic) continue;
    tags.push_back({{"material", material.name}, {"triangles", triangles[m]}, {"tag", tag_json(*material.haptic)}});
    tags.back()["warnings"] = Json::array();
    for (const HapticWarning& warning : material.haptic_warnings)
      tags.back()["warnings"].push_back(warning.code + ": " + warning.message);
  }
  Json haptic{{"tags", tags}};
  haptic.update(tags_json(scene.tags));
  return haptic;
}

Json faces_json(const std::vector<CadFaceNote>& notes) {
  Json faces = Json::array();
  for (const CadFaceNote& note : notes)
    faces.push_back({{"part", note.part}, {"face", note.face}, {"reason", note.reason}, {"tried", note.tried}});
  return faces;
}

Json simplified_part_json(const std::string& name, const SimplifyResult& part, std::size_t triangles_after) {
  return {{"name", name},
          {"triangles_before", part.triangles_before},
          {"triangles_after", triangles_after},
          {"max_deviation_mm", part.deviation.bound()},
          {"max_deviation_met_mm", part.deviation.value()}};
}

Json perception_json(const std::string& name, const PartPerception& part) {
  const bool reach = part.in_reach.has_value(), view = part.visible_fraction.has_value();
  return {{"part", name},
          {"instances", part.instances},
          {"in_reach", or_null(part.in_reach)},
          {"instances_in_reach", reach ? Json(part.instances_in_reach) : Json(nullptr)},
          {"visible_fraction", or_null(part.visible_fraction)},
          {"instances_seen", view ? Json(part.instances_seen) : Json(nullptr)},
          {"left_out", part.left_out.empty() ? Json(nullptr) : Json(std::string(part.left_out))},
          {"instances_left_out", part.instances_left_out}};
}

}  // namespace

Json trace_json(const Trace& trace) {
  Json json = Json::array();
  for (const TraceSample& s : trace) json.push_back({{"seconds", s.seconds}, {"error", s.error}});
  return json;
}

Json counters_json(const MeshStatistics& s) {
  return {{"triangles", s.triangles},
          {"vertices", s.vertices},
          {"components", s.components},
          {"boundary_loops", s.boundary_loops},
          {"genus", s.genus},
          {"nonmanifold_edges", s.nonmanifold_edges},
          {"degenerate_triangles", s.degenerate_triangles},
          {"duplicate_triangles", s.duplicate_triangles},
          {"flipped_edges", s.flipped_edges},
          {"t_junctions", s.t_junctions},
          {"aspect_max", s.aspect_max},
          {"has_uv", s.has_uv}};
}

Json shared_parts_json(const std::vector<SharedPart>& shared, const Scene& scene) {
  Json json = Json::array();
  for (const SharedPart& part : shared)
    json.push_back({{"part", part.name},
                    {"id", part.id},
                    {"copy_of", shown_name(scene.parts[part.original])},
                    {"max_distance_mm", part.max_distance_mm}});
  return json;
}

Json perception_json(const Scene& scene, const ScenePerception& perception) {
  Json json = Json::array();
  for (std::size_t p = 0; p < perception.parts.size(); ++p)
    json.push_back(perception_json(shown_name(scene.parts[p]), perception.parts[p]));
  return json;
}

Json budget_json(const Scene& scene, std::size_t wanted, const BudgetResult& budget,
                 const std::vector<SimplifyResult>& parts, const std::vector<std::size_t>& triangles_after) {
  Json list = Json::array();
  for (std::size_t i = 0; i < parts.size(); ++i)
    list.push_back(simplified_part_json(shown_name(scene.parts[i]), parts[i], triangles_after[i]));
  return {{"wanted", wanted},
          {"triangles", budget.triangles},
          {"reached", budget.reached},
          {"tolerance_mm", budget.tolerance_mm},
          {"trace", trace_json(budget.trace)},
          {"parts", list}};
}

Json inspect_json(const Scene& scene, const std::vector<MeshStatistics>& statistics,
                  const std::optional<ScenePerception>& perception, const Json& sides) {
  const Vec3 size = scene_bounds(scene).size();
  Json json{{"format", scene.format}, {"units", scene.unit}, {"millimetres_per_unit", scene.millimetres_per_unit}};
  json["size_mm"] = {size.x, size.y, size.z};
  json["parts"] = parts_json(scene, statistics);
  json["totals"] = counters_json(total_statistics(statistics));
  json["totals"]["drawn_triangles"] = drawn_triangles(scene);
  json["materials"] = materials_json(scene);
  json["haptic"] = haptic_json(scene);
  json["asset"] = {{"copyright", scene.asset.copyright}, {"generators", scene.asset.generators}};
  if (!scene.asset.extras_json.empty()) json["asset"]["extras"] = Json::parse(scene.asset.extras_json);
  json["warnings"] = scene.warnings;
  json["losses"] = scene.losses;
  json["sides"] = sides;
  if (perception) json["perception"] = perception_json(scene, *perception);
  return json;
}

Json nodes_json(const std::vector<SurfacePlace>& places) {
  const auto first = [](const std::vector<std::string>& names) {
    return names.empty() ? Json(nullptr) : Json(names.front());
  };
  Json nodes = Json::array();
  for (const SurfacePlace& place : places)
    nodes.push_back({{"part", first(place.parts)},
                     {"node", first(place.nodes)},
                     {"layers", place.layers},
                     {"cad_materials", place.cad_materials},
                     {"colour", first(place.colours)},
                     {"material", first(place.materials)}});
  return nodes;
}

Json tessellation_json(const Scene& scene, const CadReport& report) {
  const std::vector<std::size_t> uses = uses_of_parts(scene);
  std::map<std::string, const CadPartReport*> measured;
  for (const CadPartReport& part : report.parts) measured.emplace(part.part, &part);
  Json parts = Json::array();
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const Part& part = scene.parts[i];
    Json materials = Json::array();
    for (const std::uint32_t m : part.materials) materials.push_back(scene.materials[m].name);
    parts.push_back({{"name", shown_name(part)},
                     {"id", part.id},
                     {"triangles", part.mesh.triangles.size()},
                     {"vertices", part.mesh.positions.size()},
                     {"instances", uses[i]},
                     {"materials", std::move(materials)}});
    if (const auto found = measured.find(part.id); found != measured.end()) {
      parts.back()["max_deviation_mm"] = found->second->max_deviation_mm;
      parts.back()["max_angle_deg"] = found->second->max_angle_deg;
      parts.back()["added_nodes"] = found->second->added_nodes;
    }
  }
  return {
      {"format", scene.format},
      {"unit", scene.unit},
      {"parts", parts},
      {"triangles", report.triangles},
      {"solids", report.solids},
      {"faces", report.faces},
      {"failed_faces", faces_json(report.failed_faces)},
      {"repaired_faces", faces_json(report.repaired_faces)},
      {"off_faces", faces_json(report.off_faces)},
      {"dropped_triangles", report.dropped_triangles},
      {"max_deviation_mm", report.max_deviation_mm},
      {"max_angle_deg", report.max_angle_deg},
      {"added_nodes", report.added_nodes},
      {"stages",
       {{"read", report.seconds_read}, {"tessellate", report.seconds_tessellate}, {"convert", report.seconds_convert}}},
      {"losses", scene.losses},
      {"warnings", scene.warnings}};
}

Json repair_numbers_json(const RepairResult& result) {
  Json operations;
  for (const auto& [name, count] : k_repair_counts) operations[std::string(name)] = result.counts.*count;
  const RepairDeviations& d = result.deviations;
  return {{"operations", operations},
          {"deviations_mm",
           {{"weld", d.weld},
            {"degenerate", d.degenerate},
            {"t_junctions", d.t_junctions},
            {"partings", d.partings},
            {"stitches", d.stitches}}},
          {"tolerance_mm", result.tolerance_mm},
          {"lost_mm", result.lost_mm},
          {"added_mm", result.added_mm},
          {"sampled", result.sampled},
          {"refused", {{"triangles", result.refused_triangles}, {"deviation_mm", result.refused_mm}}},
          {"unfinished_triangles", result.unfinished_triangles}};
}

Json repair_json(const RepairSceneResult& result, const WrittenRepair& written, const RepairSceneOptions& options) {
  Json unsettled = Json::array();
  for (std::size_t i = 0; i < result.parts.size(); ++i)
    if (!result.parts[i].settled) unsettled.push_back(shown_name(result.scene.parts[i]));
  Json json{{"before", counters_json(result.before)},
            {"after", counters_json(written.after)},
            {"max_deviation_mm", written.max_deviation_mm(result.total)},
            {"rounding_mm", written.rounding_mm},
            {"weld_tolerance_mm", result.total.weld_tolerance_mm}};
  json.update(repair_numbers_json(result.total));
  json.update({{"sides", sides_json(result.sides, options.sides)},
               {"parts", result.parts.size()},
               {"identical_parts", shared_parts_json(result.shared, result.scene)},
               {"unsettled", unsettled},
               {"stop", to_string(result.stop)},
               {"losses", result.scene.losses},
               {"warnings", result.scene.warnings},
               {"seconds", result.seconds}});
  return json;
}

Json simplify_json(const SimplifySceneResult& result, const SimplifySceneOptions& options) {
  const Scene& scene = result.scene;
  Json json = {{"triangles_before", result.triangles_before},
               {"identical_parts", shared_parts_json(result.shared, scene)}};
  if (result.perception) json["perception"] = perception_json(scene, *result.perception);
  if (result.budget)
    json["budget"] = budget_json(scene, *options.budget, *result.budget, result.parts, result.triangles);
  json["max_deviation_mm"] = result.max_deviation_mm;
  json["max_deviation_met_mm"] = result.max_deviation_met_mm;
  if (options.levels.asked()) json["levels"] = Json::array();
  for (const LevelReport& level : result.levels)
    if (level.level > 0)
      json["levels"].push_back({{"part", shown_name(scene.parts[level.part])},
                                {"level", level.level},
                                {"tolerance_mm", level.tolerance_mm},
                                {"triangles", level.triangles},
                                {"max_deviation_mm", level.max_deviation_mm},
                                {"screen_coverage", level.screen_coverage}});
  json["triangles_after"] = result.triangles_after;
  json["stop"] = to_string(result.stop);
  json["parts"] = Json::array();
  for (std::size_t i = 0; i < result.parts.size(); ++i) {
    const SimplifyResult& part = result.parts[i];
    if (part.triangles_before == 0) continue;
    json["parts"].push_back(simplified_part_json(shown_name(scene.parts[i]), part, result.triangles[i]));
    json["parts"].back()["stop"] = to_string(part.stop);
    json["parts"].back()["trace"] = trace_json(part.trace);
  }
  json["losses"] = scene.losses;
  json["warnings"] = scene.warnings;
  json["seconds"] = result.seconds;
  return json;
}

}  // namespace papilla::app
