// SPDX-License-Identifier: GPL-3.0-or-later
#include "distortion_report.hpp"

#include <fmt/format.h>

#include <iterator>

#include "bake/mesh_assembly.hpp"
#include "papilla/core/error.hpp"

namespace papilla::app {
namespace {

Json json_of(const MeanMax& m) { return {{"mean", m.mean}, {"max", m.max}}; }
Json json_of(const MinMeanMax& m) { return {{"min", m.min}, {"mean", m.mean}, {"max", m.max}}; }
Json json_of(const Percentiles& p) { return {{"p50", p.p50}, {"p90", p.p90}, {"p99", p.p99}}; }

}  // namespace

SceneDistortion measure_scene(const Scene& scene, MeasureOptions options,
                              const std::function<bool(std::size_t)>& wanted) {
  SceneDistortion result;
  for (std::uint32_t p = 0; p < scene.parts.size(); ++p) {
    const TriangleMesh& mesh = scene.parts[p].mesh;
    if (mesh.uv.empty() || mesh.triangles.empty() || (wanted && !wanted(p))) continue;
    TriangleMesh shape;
    shape.positions = mesh.positions;
    shape.triangles = mesh.triangles;
    shape.uv = mesh.uv;
    append_mesh(result.mesh, shape);
    result.part.resize(result.mesh.triangles.size(), p);
  }
  if (result.mesh.triangles.empty()) throw InvalidInput("no part has texture coordinates to measure");
  options.part = result.part;
  result.report = measure_distortion(result.mesh, result.mesh.uv, options);
  return result;
}

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

std::string distortion_text(const DistortionReport& r) {
  return fmt::format(
      "{} triangles in {} charts, seams {:.1f} mm\n"
      "flipped {}, mirrored charts {}, degenerate {} in space and {} in uv\n"
      "overlap {:.4g} of the uv area, {:.4g} within charts\n"
      "symmetric Dirichlet {:.4f} (max {:.4g}), stretch L2 {:.4f}, L∞ {:.4g}\n"
      "angle error {:.3f}° (max {:.3g}°), area ratio {:.4g} to {:.4g}, edge length error {:.3g}\n",
      r.triangles, r.charts, r.seam_length_mm, r.flipped, r.mirrored_charts, r.degenerate_3d, r.degenerate_uv,
      r.overlap_area_fraction, r.overlap_within_charts, r.symmetric_dirichlet.mean, r.symmetric_dirichlet.max,
      r.stretch_l2, r.stretch_linf, r.angle_error_deg.mean, r.angle_error_deg.max, r.area_ratio.min, r.area_ratio.max,
      r.edge_length_error);
}

std::string distortion_csv(const SceneDistortion& distortion) {
  std::string csv =
      "part,triangle,chart,area_mm2,sigma1,sigma2,symmetric_dirichlet,stretch_l2,angle_error_deg,texels_per_mm,"
      "flipped,degenerate_3d,degenerate_uv,overlaps_chart,overlaps_any\n";
  std::size_t first = 0;
  for (std::size_t t = 0; t < distortion.part.size(); ++t) {
    if (t > 0 && distortion.part[t] != distortion.part[t - 1]) first = t;
    const TriangleDistortion& d = distortion.report.per_triangle[t];
    fmt::format_to(std::back_inserter(csv),
                   "{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:d},{:d},{:d},{:d},{:d}\n",
                   distortion.part[t], t - first, d.chart, d.area_mm2, d.sigma1, d.sigma2, d.symmetric_dirichlet,
                   d.stretch_l2, d.angle_error_deg, d.texels_per_mm, d.flipped, d.degenerate_3d, d.degenerate_uv,
                   d.overlaps_chart, d.overlaps_any);
  }
  return csv;
}

}  // namespace papilla::app
