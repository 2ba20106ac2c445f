// SPDX-License-Identifier: GPL-3.0-or-later
#include "distortion_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>

#include "papilla/core/error.hpp"
#include "papilla/core/srgb.hpp"
#include "papilla/meshing/mesh_assembly.hpp"
#include "pictures/uv_layout.hpp"

namespace papilla::app {
namespace {

Json json_of(const MeanMax& m) { return {{"mean", m.mean}, {"max", m.max}}; }
Json json_of(const MinMeanMax& m) { return {{"min", m.min}, {"mean", m.mean}, {"max", m.max}}; }
Json json_of(const Percentiles& p) { return {{"p50", p.p50}, {"p90", p.p90}, {"p99", p.p99}}; }

/// Symmetric Dirichlet of a map that changes no length.
constexpr double k_isometry = 4;

/// Upper ends of the bins; a last one follows without end.
constexpr std::array k_dirichlet_bins{4.0001, 4.001, 4.003, 4.01, 4.03, 4.1, 4.3, 5.0, 7.0, 14.0, 104.0};
constexpr std::array k_stretch_bins{1.0001, 1.001, 1.003, 1.01, 1.03, 1.1, 1.3, 2.0, 4.0, 10.0};
constexpr std::array k_angle_bins{0.1, 0.3, 1.0, 2.0, 3.0, 5.0, 10.0, 20.0, 40.0};

template <std::size_t N>
std::vector<double> shares(const DistortionReport& report, const std::array<double, N>& bins,
                           double TriangleDistortion::*value) {
  std::vector<double> share(N + 1, 0);
  double total = 0;
  for (const TriangleDistortion& d : report.per_triangle) {
    if (!d.measured) continue;
    const auto bin = std::lower_bound(bins.begin(), bins.end(), d.*value) - bins.begin();
    share[static_cast<std::size_t>(bin)] += d.area_mm2;
    total += d.area_mm2;
  }
  for (double& s : share) s = total > 0 ? s / total : 0;
  return share;
}

float linear(unsigned char srgb) { return static_cast<float>(linear_from_srgb(srgb / 255.0)); }

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

Json worst_chart_json(const Scene& scene, const SceneDistortion& distortion) {
  struct Sums {
    double area = 0, excess = 0;
    std::size_t worst = 0;  ///< Triangle.
  };
  const std::vector<TriangleDistortion>& triangles = distortion.report.per_triangle;
  std::map<std::uint32_t, Sums> charts;
  double total = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const TriangleDistortion& d = triangles[t];
    if (!d.measured) continue;
    const auto [chart, is_new] = charts.try_emplace(d.chart);
    Sums& sums = chart->second;
    if (is_new || d.symmetric_dirichlet > triangles[sums.worst].symmetric_dirichlet) sums.worst = t;
    const double excess = d.area_mm2 * (d.symmetric_dirichlet - k_isometry);
    sums.area += d.area_mm2, sums.excess += excess, total += excess;
  }
  if (!(total > 0)) return {};
  const auto& [chart, sums] = *std::max_element(
      charts.begin(), charts.end(), [](const auto& a, const auto& b) { return a.second.excess < b.second.excess; });
  const std::uint32_t part = distortion.part[sums.worst];
  const auto first = std::lower_bound(distortion.part.begin(), distortion.part.end(), part) - distortion.part.begin();
  return {{"part", scene.parts[part].name},
          {"chart", chart},
          {"triangle", sums.worst - static_cast<std::size_t>(first)},
          {"symmetric_dirichlet",
           {{"mean", k_isometry + sums.excess / sums.area}, {"max", triangles[sums.worst].symmetric_dirichlet}}},
          {"area_mm2", sums.area},
          {"share_of_distortion", sums.excess / total}};
}

std::string distortion_text(const DistortionReport& r, const Json& worst_chart) {
  std::string text = fmt::format(
      "{} triangles in {} charts, seams {:.1f} mm\n"
      "flipped {}, mirrored charts {}, degenerate {} in space and {} in uv\n"
      "overlap {:.4g} of the uv area, {:.4g} within charts\n"
      "symmetric Dirichlet {:.4f} by area, half below {:.4f}, 99 % below {:.4f}, max {:.4g}\n"
      "stretch L2 {:.4f}, L∞ {:.4g}\n"
      "angle error {:.3f}° (max {:.3g}°), area ratio {:.4g} to {:.4g}, edge length error {:.3g}\n",
      r.triangles, r.charts, r.seam_length_mm, r.flipped, r.mirrored_charts, r.degenerate_3d, r.degenerate_uv,
      r.overlap_area_fraction, r.overlap_within_charts, r.symmetric_dirichlet.mean,
      r.symmetric_dirichlet_percentiles.p50, r.symmetric_dirichlet_percentiles.p99, r.symmetric_dirichlet.max,
      r.stretch_l2, r.stretch_linf, r.angle_error_deg.mean, r.angle_error_deg.max, r.area_ratio.min, r.area_ratio.max,
      r.edge_length_error);
  if (!worst_chart.is_null())
    text +=
        fmt::format("most of it in chart {} of part '{}': {:.3g} % of the distortion, at triangle {} {:.4g}\n",
                    worst_chart["chart"].get<std::uint32_t>(), worst_chart["part"].get<std::string>(),
                    100 * worst_chart["share_of_distortion"].get<double>(), worst_chart["triangle"].get<std::size_t>(),
                    worst_chart["symmetric_dirichlet"]["max"].get<double>());
  return text;
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

Json histogram_json(const DistortionReport& report) {
  const auto one = [&](const auto& bins, double TriangleDistortion::*value) {
    return Json{{"below", bins}, {"area_fraction", shares(report, bins, value)}};
  };
  return {{"symmetric_dirichlet", one(k_dirichlet_bins, &TriangleDistortion::symmetric_dirichlet)},
          {"stretch_l2", one(k_stretch_bins, &TriangleDistortion::stretch_l2)},
          {"angle_error_deg", one(k_angle_bins, &TriangleDistortion::angle_error_deg)}};
}

std::string histogram_text(const DistortionReport& report) {
  const std::vector<double> share = shares(report, k_dirichlet_bins, &TriangleDistortion::symmetric_dirichlet);
  std::string text = "symmetric Dirichlet, share of the area:\n";
  for (std::size_t i = 0; i < share.size(); ++i) {
    const bool last = i == k_dirichlet_bins.size();
    text += fmt::format("  {} {:<8} {:6.2f} % {}\n", last ? "above" : "up to", k_dirichlet_bins[last ? i - 1 : i],
                        100 * share[i], std::string(static_cast<std::size_t>(std::lround(40 * share[i])), '#'));
  }
  return text;
}

void colour_by_distortion(const SceneDistortion& distortion, double worst, Scene& scene) {
  std::size_t next = 0;
  scene.materials.assign(1, {});
  scene.materials.front().name = "distortion";
  for (Part& part : scene.parts) {
    TriangleMesh& mesh = part.mesh;
    mesh.colors = {};
    mesh.colors.values.reserve(mesh.triangles.size());
    const bool measured = !mesh.uv.empty() && !mesh.triangles.empty();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto i = static_cast<Index>(t);
      mesh.colors.indices.push_back({i, i, i});
      if (!measured || !mesh.uv.has_value(t)) {
        mesh.colors.values.push_back({0.5F, 0.5F, 0.5F, 1});
        continue;
      }
      const Rgb c = distortion_colour(distortion.report.per_triangle[next + t], worst);
      mesh.colors.values.push_back({linear(c[0]), linear(c[1]), linear(c[2]), 1});
    }
    if (measured) next += mesh.triangles.size();
    mesh.material.clear();
    part.materials = {0};
  }
}

}  // namespace papilla::app
