// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "papilla/io/node_places.hpp"
#include "shown_format.hpp"
#include "text/scene_text.hpp"

namespace papilla::app {

namespace {

std::string overlap_line(const DistortionReport& r) {
  if (!r.has_overlap) return "overlap not looked for: the time limit left no time for it\n";
  return shown_format("overlap {:.4g} of the uv area, {:.4g} within charts\n", r.overlap_area_fraction,
                      r.overlap_within_charts);
}

}  // namespace

std::string distortion_text(const Scene& scene, const SceneDistortion& distortion) {
  const DistortionReport& r = distortion.report;
  std::string text = shown_format(
      "{} triangles in {} charts, seams {:.1f} mm\n"
      "flipped {}, mirrored charts {}, degenerate {} in space and {} in uv\n"
      "{}"
      "symmetric Dirichlet {:.4f} by area, half below {:.4f}, 99 % below {:.4f}, max {:.4g}\n"
      "stretch L2 {:.4f}, L∞ {:.4g}\n"
      "angle error {:.3f}° (max {:.3g}°), area ratio {:.4g} to {:.4g}, edge length error {:.3g}\n",
      r.triangles, r.charts, r.seam_length_mm, r.flipped, r.mirrored_charts, r.degenerate_3d, r.degenerate_uv,
      overlap_line(r), r.symmetric_dirichlet.mean, r.symmetric_dirichlet_percentiles.p50,
      r.symmetric_dirichlet_percentiles.p99, r.symmetric_dirichlet.max, r.stretch_l2, r.stretch_linf,
      r.angle_error_deg.mean, r.angle_error_deg.max, r.area_ratio.min, r.area_ratio.max, r.edge_length_error);
  if (const auto worst = worst_chart(distortion))
    text += shown_format("most of it in chart {} of part '{}': {:.3g} % of the distortion, at triangle {} {:.4g}\n",
                         worst->chart, shown_name(scene.parts[worst->part]), 100 * worst->share, worst->triangle,
                         worst->max);
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

std::string histogram_text(const DistortionReport& report) {
  const DistortionHistogram histogram = dirichlet_histogram(report);
  std::string text = "symmetric Dirichlet, share of the area:\n";
  for (std::size_t i = 0; i < histogram.area_shares.size(); ++i) {
    const bool last = i == histogram.upper_ends.size();
    const double share = histogram.area_shares[i];
    text += shown_format("  {} {:<8} {:6.2f} % {}\n", last ? "above" : "up to", histogram.upper_ends[last ? i - 1 : i],
                         100 * share, std::string(static_cast<std::size_t>(std::lround(40 * share)), '#'));
  }
  return text;
}

}  // namespace papilla::app
