// SPDX-License-Identifier: MIT
#include "papilla/meshing/segmentation.hpp"

#include <string>

#include "chart_merge.hpp"
#include "check_mesh.hpp"
#include "cone_split.hpp"
#include "disk_cut.hpp"
#include "papilla/core/error.hpp"
#include "surface.hpp"

namespace papilla {
namespace {

using namespace detail;

void check_options(const SegmentationOptions& options) {
  const auto require = [](bool valid, const char* name, double value) {
    if (!valid)
      throw InvalidInput(std::string("segment_charts: ") + name + " " + std::to_string(value) + " is out of range");
  };
  const auto is_angle = [](double a) { return a > 0 && a <= 180; };
  const auto is_fraction = [](double f) { return f >= 0 && f <= 1; };
  require(is_angle(options.feature_angle_deg), "feature_angle_deg", options.feature_angle_deg);
  require(is_angle(options.max_normal_deviation_deg), "max_normal_deviation_deg", options.max_normal_deviation_deg);
  require(is_fraction(options.outlier_area_fraction), "outlier_area_fraction", options.outlier_area_fraction);
  require(is_fraction(options.speck_area_fraction), "speck_area_fraction", options.speck_area_fraction);
  require(is_fraction(options.small_area_fraction), "small_area_fraction", options.small_area_fraction);
}

double seam_length(const Surface& surface, const std::vector<std::uint32_t>& labels) {
  double length = 0;
  for (Index h = 0; h < surface.opposite.size(); ++h) {
    const Index other = surface.opposite[h];
    if (other != k_none && other > h && labels[triangle_of(h)] != labels[triangle_of(other)])
      length += surface.length(h);
  }
  return length;
}

}  // namespace

SegmentationResult segment_charts(const TriangleMesh& mesh, const SegmentationOptions& options) {
  check_options(options);
  check_mesh(mesh, "segment_charts");
  const auto tell = [&](double fraction) {
    if (options.progress) options.progress("charts", fraction);
  };
  SegmentationResult result;
  const Surface surface(mesh);
  const std::vector<std::uint8_t> feature = feature_halfedges(surface, options.feature_angle_deg);
  tell(0.2);

  std::uint32_t count = 0;
  std::vector<std::uint32_t> labels = feature_patches(surface, feature, count);
  result.feature_patches = count;
  split_by_cones(surface, feature, options, labels);
  tell(0.6);
  result.cone_charts = count = merge_fitting(surface, feature, options, labels);
  count = absorb_small(surface, feature, options, labels);
  result.absorbed = result.cone_charts - count;
  tell(0.8);

  if (options.disks) result.disk_cuts = cut_to_disks(mesh, surface, options.progress, count, labels);
  result.charts.count = renumber(labels);
  result.charts.seam_length_mm = seam_length(surface, labels);
  result.charts.of_triangle = std::move(labels);
  tell(1);
  return result;
}

}  // namespace papilla
