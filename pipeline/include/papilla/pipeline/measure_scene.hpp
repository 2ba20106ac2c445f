// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "papilla/io/scene.hpp"
#include "papilla/param/measure.hpp"

namespace papilla {

/// The normalizations by the names that the command line has for them.
const std::map<std::string, UvNormalization>& uv_normalizations();
std::string uv_normalization_name(UvNormalization normalization);

/// The distortion of all parts of a scene that have uv, as one list of triangles.
struct SceneDistortion {
  TriangleMesh mesh;                ///< All parts that have uv, in their own frames.
  std::vector<std::uint32_t> part;  ///< Per triangle: number in Scene::parts.
  DistortionReport report;          ///< Overlap counts within parts only.
};

/// @param options its `part` is set here.
/// @throws InvalidInput when no part has uv.
SceneDistortion measure_scene(const Scene& scene, MeasureOptions options = {});

/// The chart that has the largest share of a scene's distortion, Σ A (E - 4) of symmetric Dirichlet E over area A: one
/// sliver can make up most of the mean.
struct WorstChart {
  std::uint32_t part = 0;    ///< In Scene::parts.
  std::uint32_t chart = 0;   ///< Of the report.
  std::size_t triangle = 0;  ///< Of the part: the most distorted one.
  double mean = 0, max = 0;  ///< Symmetric Dirichlet.
  double area_mm2 = 0;
  double share = 0;  ///< Of the scene's distortion, in (0, 1].
};

/// Nothing when there is no distortion.
std::optional<WorstChart> worst_chart(const SceneDistortion& distortion);

/// How a surface's area spreads over one measure of distortion: share i lies below upper_ends[i] and not below the bin
/// before; the last share has no upper end.
struct DistortionHistogram {
  std::vector<double> upper_ends, area_shares;
};
DistortionHistogram dirichlet_histogram(const DistortionReport& report);
DistortionHistogram stretch_histogram(const DistortionReport& report);
DistortionHistogram angle_histogram(const DistortionReport& report);

/// Summed distortion of several surfaces: means weighted by area, counts added.
struct DistortionTotals {
  std::size_t triangles = 0, charts = 0, flipped = 0, overlapping_within_charts = 0;
  bool has_overlap = true;  ///< Of all surfaces.
  double area_mm2 = 0;
  /// 0 without area.
  double symmetric_dirichlet_mean = 0, angle_error_deg_mean = 0, stretch_l2 = 0, stretch_linf = 0;
};
DistortionTotals total_distortion(const std::vector<const DistortionReport*>& reports);

/// Gives every triangle that has uv the colour of its distortion, as corner colours; the others are grey.
/// @param report of measure_scene() for this scene.
void colour_by_distortion(const SceneDistortion& distortion, double worst, Scene& scene);

}  // namespace papilla
