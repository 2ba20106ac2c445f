// SPDX-License-Identifier: MIT
#include "papilla/pipeline/measure_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "papilla/core/error.hpp"
#include "papilla/core/srgb.hpp"
#include "papilla/meshing/mesh_assembly.hpp"
#include "papilla/pipeline/pictures/uv_layout.hpp"

namespace papilla {
namespace {

/// Symmetric Dirichlet of a map that changes no length.
constexpr double k_isometry = 4;

/// Upper ends of the bins; a last one follows without end.
constexpr std::array k_dirichlet_bins{4.0001, 4.001, 4.003, 4.01, 4.03, 4.1, 4.3, 5.0, 7.0, 14.0, 104.0};
constexpr std::array k_stretch_bins{1.0001, 1.001, 1.003, 1.01, 1.03, 1.1, 1.3, 2.0, 4.0, 10.0};
constexpr std::array k_angle_bins{0.1, 0.3, 1.0, 2.0, 3.0, 5.0, 10.0, 20.0, 40.0};

template <std::size_t N>
DistortionHistogram histogram(const DistortionReport& report, const std::array<double, N>& bins,
                              double TriangleDistortion::*value) {
  DistortionHistogram result{{bins.begin(), bins.end()}, std::vector<double>(N + 1, 0)};
  double total = 0;
  for (const TriangleDistortion& d : report.per_triangle) {
    if (!d.measured) continue;
    const auto bin = std::lower_bound(bins.begin(), bins.end(), d.*value) - bins.begin();
    result.area_shares[static_cast<std::size_t>(bin)] += d.area_mm2;
    total += d.area_mm2;
  }
  for (double& share : result.area_shares) share = total > 0 ? share / total : 0;
  return result;
}

float linear(unsigned char srgb) { return static_cast<float>(linear_from_srgb(srgb / 255.0)); }

}  // namespace

const std::map<std::string, UvNormalization>& uv_normalizations() {
  static const std::map<std::string, UvNormalization> names{{"scene", UvNormalization::scene},
                                                            {"part", UvNormalization::part},
                                                            {"chart", UvNormalization::chart},
                                                            {"none", UvNormalization::none}};
  return names;
}

std::string uv_normalization_name(UvNormalization normalization) {
  const auto& names = uv_normalizations();
  return std::find_if(names.begin(), names.end(), [&](const auto& n) { return n.second == normalization; })->first;
}

SceneDistortion measure_scene(const Scene& scene, MeasureOptions options) {
  SceneDistortion result;
  for (std::uint32_t p = 0; p < scene.parts.size(); ++p) {
    const TriangleMesh& mesh = scene.parts[p].mesh;
    if (mesh.uv.empty() || mesh.triangles.empty()) continue;
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

std::optional<WorstChart> worst_chart(const SceneDistortion& distortion) {
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
  if (!(total > 0)) return std::nullopt;
  const auto& [chart, sums] = *std::max_element(
      charts.begin(), charts.end(), [](const auto& a, const auto& b) { return a.second.excess < b.second.excess; });
  const std::uint32_t part = distortion.part[sums.worst];
  const auto first = std::lower_bound(distortion.part.begin(), distortion.part.end(), part) - distortion.part.begin();
  return WorstChart{part,
                    chart,
                    sums.worst - static_cast<std::size_t>(first),
                    k_isometry + sums.excess / sums.area,
                    triangles[sums.worst].symmetric_dirichlet,
                    sums.area,
                    sums.excess / total};
}

DistortionHistogram dirichlet_histogram(const DistortionReport& report) {
  return histogram(report, k_dirichlet_bins, &TriangleDistortion::symmetric_dirichlet);
}

DistortionHistogram stretch_histogram(const DistortionReport& report) {
  return histogram(report, k_stretch_bins, &TriangleDistortion::stretch_l2);
}

DistortionHistogram angle_histogram(const DistortionReport& report) {
  return histogram(report, k_angle_bins, &TriangleDistortion::angle_error_deg);
}

DistortionTotals total_distortion(const std::vector<const DistortionReport*>& reports) {
  DistortionTotals total;
  double stretch2 = 0;
  for (const DistortionReport* report : reports) {
    total.area_mm2 += report->area_mm2;
    total.symmetric_dirichlet_mean += report->area_mm2 * report->symmetric_dirichlet.mean;
    total.angle_error_deg_mean += report->area_mm2 * report->angle_error_deg.mean;
    stretch2 += report->area_mm2 * report->stretch_l2 * report->stretch_l2;
    total.stretch_linf = std::max(total.stretch_linf, report->stretch_linf);
    total.flipped += report->flipped;
    total.triangles += report->triangles;
    total.charts += report->charts;
    total.overlapping_within_charts += report->overlapping_within_charts;
    total.has_overlap = total.has_overlap && report->has_overlap;
  }
  if (!(total.area_mm2 > 0)) return total;
  total.symmetric_dirichlet_mean /= total.area_mm2;
  total.angle_error_deg_mean /= total.area_mm2;
  total.stretch_l2 = std::sqrt(stretch2 / total.area_mm2);
  return total;
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

}  // namespace papilla
