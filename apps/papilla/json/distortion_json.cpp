// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "json/scene_json.hpp"

namespace papilla::app {
namespace {

Json json_of(const DistortionHistogram& h) { return {{"below", h.upper_ends}, {"area_fraction", h.area_shares}}; }

}  // namespace

DistortionNumbers distortion_numbers(const DistortionReport& r) {
  DistortionNumbers numbers{{"triangles", r.triangles},
                            {"without_uv", r.without_uv},
                            {"charts", r.charts},
                            {"flipped", r.flipped},
                            {"mirrored_charts", r.mirrored_charts},
                            {"degenerate_3d", r.degenerate_3d},
                            {"degenerate_uv", r.degenerate_uv},
                            {"overlap_area_fraction", r.overlap_area_fraction},
                            {"overlap_within_charts", r.overlap_within_charts},
                            {"overlapping_triangles", r.overlapping_triangles},
                            {"stretch_l2", r.stretch_l2},
                            {"stretch_linf", r.stretch_linf},
                            {"symmetric_dirichlet.mean", r.symmetric_dirichlet.mean},
                            {"symmetric_dirichlet.max", r.symmetric_dirichlet.max},
                            {"conformal.mean", r.conformal.mean},
                            {"conformal.max", r.conformal.max},
                            {"area_ratio.min", r.area_ratio.min},
                            {"area_ratio.mean", r.area_ratio.mean},
                            {"area_ratio.max", r.area_ratio.max},
                            {"angle_error_deg.mean", r.angle_error_deg.mean},
                            {"angle_error_deg.max", r.angle_error_deg.max},
                            {"edge_length_error", r.edge_length_error},
                            {"maillot.length", r.maillot_length},
                            {"maillot.area", r.maillot_area},
                            {"levy.orthogonality", r.levy_orthogonality},
                            {"levy.homogeneity", r.levy_homogeneity},
                            {"green_lagrange", r.green_lagrange},
                            {"texel_density.min", r.texel_density.min},
                            {"texel_density.median", r.texel_density.median},
                            {"texel_density.max", r.texel_density.max},
                            {"percentiles.symmetric_dirichlet.p50", r.symmetric_dirichlet_percentiles.p50},
                            {"percentiles.symmetric_dirichlet.p90", r.symmetric_dirichlet_percentiles.p90},
                            {"percentiles.symmetric_dirichlet.p99", r.symmetric_dirichlet_percentiles.p99},
                            {"percentiles.stretch_l2.p50", r.stretch_percentiles.p50},
                            {"percentiles.stretch_l2.p90", r.stretch_percentiles.p90},
                            {"percentiles.stretch_l2.p99", r.stretch_percentiles.p99},
                            {"percentiles.angle_error_deg.p50", r.angle_error_percentiles.p50},
                            {"percentiles.angle_error_deg.p90", r.angle_error_percentiles.p90},
                            {"percentiles.angle_error_deg.p99", r.angle_error_percentiles.p99},
                            {"seam_length_mm", r.seam_length_mm},
                            {"seam_phase_jump", r.seam_phase_jump},
                            {"area_mm2", r.area_mm2},
                            {"uv_area", r.uv_area},
                            {"uv_scale.min", r.uv_scale.min},
                            {"uv_scale.max", r.uv_scale.max}};
  if (!r.has_overlap) std::erase_if(numbers, [](const auto& number) { return number.first.starts_with("overlap"); });
  return numbers;
}

Json distortion_json(const DistortionReport& report) {
  Json result;
  for (const auto& [name, number] : distortion_numbers(report)) {
    std::string path = '/' + name;
    std::replace(path.begin(), path.end(), '.', '/');
    std::visit([&, key = Json::json_pointer(path)](auto value) { result[key] = value; }, number);
  }
  return result;
}

Json worst_chart_json(const Scene& scene, const SceneDistortion& distortion) {
  const std::optional<WorstChart> worst = worst_chart(distortion);
  if (!worst) return {};
  return {
      {"part", scene.parts[worst->part].name}, {"chart", worst->chart},
      {"triangle", worst->triangle},           {"symmetric_dirichlet", {{"mean", worst->mean}, {"max", worst->max}}},
      {"area_mm2", worst->area_mm2},           {"share_of_distortion", worst->share}};
}

Json histogram_json(const DistortionReport& report) {
  return {{"symmetric_dirichlet", json_of(dirichlet_histogram(report))},
          {"stretch_l2", json_of(stretch_histogram(report))},
          {"angle_error_deg", json_of(angle_histogram(report))}};
}

}  // namespace papilla::app
