// SPDX-License-Identifier: GPL-3.0-or-later
#include "json/scene_json.hpp"

namespace papilla::app {
namespace {

Json json_of(const MeanMax& m) { return {{"mean", m.mean}, {"max", m.max}}; }
Json json_of(const MinMeanMax& m) { return {{"min", m.min}, {"mean", m.mean}, {"max", m.max}}; }
Json json_of(const Percentiles& p) { return {{"p50", p.p50}, {"p90", p.p90}, {"p99", p.p99}}; }
Json json_of(const DistortionHistogram& h) { return {{"below", h.upper_ends}, {"area_fraction", h.area_shares}}; }

}  // namespace

Json distortion_json(const DistortionReport& r) {
  return {{"triangles", r.triangles},
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
          {"symmetric_dirichlet", json_of(r.symmetric_dirichlet)},
          {"conformal", json_of(r.conformal)},
          {"area_ratio", json_of(r.area_ratio)},
          {"angle_error_deg", json_of(r.angle_error_deg)},
          {"edge_length_error", r.edge_length_error},
          {"maillot", {{"length", r.maillot_length}, {"area", r.maillot_area}}},
          {"levy", {{"orthogonality", r.levy_orthogonality}, {"homogeneity", r.levy_homogeneity}}},
          {"green_lagrange", r.green_lagrange},
          {"texel_density",
           {{"min", r.texel_density.min}, {"median", r.texel_density.median}, {"max", r.texel_density.max}}},
          {"percentiles",
           {{"symmetric_dirichlet", json_of(r.symmetric_dirichlet_percentiles)},
            {"stretch_l2", json_of(r.stretch_percentiles)},
            {"angle_error_deg", json_of(r.angle_error_percentiles)}}},
          {"seam_length_mm", r.seam_length_mm},
          {"seam_phase_jump", r.seam_phase_jump},
          {"area_mm2", r.area_mm2},
          {"uv_area", r.uv_area}};
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
