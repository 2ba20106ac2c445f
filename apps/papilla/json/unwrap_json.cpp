// SPDX-License-Identifier: GPL-3.0-or-later
#include "json/scene_json.hpp"
#include "papilla/io/node_places.hpp"

namespace papilla::app {
namespace {

Json choices_json(const std::vector<ChartChoice>& choices) {
  Json json = Json::array();
  for (const ChartChoice& c : choices) json.push_back({{"chart", c.chart}, {"method", c.method}, {"reason", c.reason}});
  return json;
}

/// What the method minimises, in its own unit: how much of it the start had, and how much is left.
Json error_json(const Trace& trace) {
  if (trace.empty()) return {};
  return {{"start", trace.front().error}, {"end", trace.back().error}};
}

/// Null without a bound.
Json bound_json(const std::optional<BoundReport>& report) {
  if (!report) return {};
  Json trace = Json::array();
  for (const SeamSample& s : report->trace)
    trace.push_back({{"seconds", s.seconds},
                     {"triangles", s.triangles},
                     {"seam_mm", s.seam_mm},
                     {"seam_cost_mm", s.seam_cost_mm},
                     {"distortion", s.distortion}});
  return {{"wanted", distortion_bound_name(report->bound)},
          {"kept", report->kept},
          {"distortion", report->distortion},
          {"seam_mm", report->seam_mm},
          {"seam_cost_mm", report->seam_cost_mm},
          {"trace", std::move(trace)}};
}

Json parts_json(const UnwrapResult& result) {
  Json parts = Json::array();
  for (std::size_t p = 0; p < result.parts.size(); ++p) {
    const UnwrappedPart& part = result.parts[p];
    Json notes = Json::array();
    for (const ChartNote& note : part.flattening.notes) notes.push_back(note.reason);
    parts.push_back({{"name", shown_name(result.scene.parts[p])},
                     {"triangles", result.scene.parts[p].mesh.triangles.size()},
                     {"method", part.method},
                     {"reason", part.reason.empty() ? Json() : Json(part.reason)},
                     {"charts", part.flattening.charts.count},
                     {"choices", choices_json(part.choices)},
                     {"error", error_json(part.flattening.trace)},
                     {"bound", bound_json(part.bound)},
                     {"seam_length_mm", part.flattening.charts.seam_length_mm},
                     {"grain_continued_mm", part.grain_continued_mm},
                     {"seam_visibility", seams_json(part.seams)},
                     {"opposed_edges", part.opposed_edges},
                     {"nonmanifold_edges", part.nonmanifold_edges},
                     {"repair_first", part.is_far_from_manifold()},
                     {"notes", std::move(notes)},
                     {"failure", part.failure.empty() ? Json() : Json(part.failure)}});
  }
  return parts;
}

}  // namespace

Json seams_json(const SeamVisibility& s) {
  return {{"seam_mm", s.seam_mm},         {"visible_mm", s.visible_mm},       {"mean_jump_mm", s.mean_jump_mm},
          {"max_jump_mm", s.max_jump_mm}, {"mean_turn_deg", s.mean_turn_deg}, {"turned_mm", s.turned_mm},
          {"per_size", s.per_size}};
}

Json unwrap_json(const UnwrapResult& result, const UnwrapOptions& options, const SceneDistortion& distortion) {
  Json unique;
  if (result.unique)
    unique = {{"fill_rate", result.unique->fill_rate},
              {"texels_per_mm", result.unique->texels_per_mm},
              {"gutter_px", result.unique->gutter_px}};
  return {{"charts", result.charts},
          {"stop", to_string(result.stop)},
          {"seconds",
           {{"segment", result.seconds.segment},
            {"solve", result.seconds.solve},
            {"pack", result.seconds.pack},
            {"total", result.seconds.total}}},
          {"fill_rate", result.fill_rate},
          {"grain_mm", result.grain_mm},
          {"unique", unique},
          {"sides", sides_json(result.sides, options.sides)},
          {"distortion", distortion_json(distortion.report)},
          {"parts", parts_json(result)},
          {"losses", result.scene.losses},
          {"warnings", result.scene.warnings}};
}

}  // namespace papilla::app
