// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Which triangles share the factor that uv are scaled by before distortion is measured.
enum class UvNormalization {
  scene,  ///< All.
  part,   ///< Those of a part (MeasureOptions::part).
  chart,  ///< Those of a chart.
  none,   ///< The factor is 1: uv count as millimetres.
};

struct MeasureOptions {
  /// With A the areas in space and a those in uv, the triangles of a group G are scaled by s = √(Σ_G A / Σ_G |a|), so
  /// that their areas agree. σ1, σ2 are those of the scaled map; so is every field made of them, of edges or of areas
  /// in uv, but for uv_area, overlap, texel_density and seam_phase_jump, which are those of the uv as they are.
  UvNormalization normalize = UvNormalization::scene;
  Vec2 texture_px{1024, 1024};  ///< Size of the texture that texel_density is counted for.
  Vec2 uv_per_texture{1, 1};    ///< How many uv units one repeat of the texture covers: 1 for texture
                                ///< coordinates of files, the tile size in mm for uv in millimetres.
  /// Per triangle: the part it belongs to; empty: one part. Charts, seams and overlap end at parts.
  std::vector<std::uint32_t> part = {};
  int overlap_rows = 4096;  ///< Rows in which the area of an overlap is summed; 64 to 65536.
  bool overlap = true;      ///< Whether overlap is looked for: a quarter of the time.
};

struct MeanMax {
  double mean = 0, max = 0;
};

struct MinMax {
  double min = 0, max = 0;
};

struct MinMeanMax {
  double min = 0, mean = 0, max = 0;
};

struct MinMedianMax {
  double min = 0, median = 0, max = 0;
};

/// Values below which the given share of the surface's area lies.
struct Percentiles {
  double p50 = 0, p90 = 0, p99 = 0;
};

/// What became of one triangle; uv scaled as MeasureOptions::normalize says.
struct TriangleDistortion {
  double area_mm2 = 0;
  double sigma1 = 0, sigma2 = 0;  ///< Singular values of the map from space to uv, sigma1 >= sigma2 >= 0.
  double symmetric_dirichlet = 0, stretch_l2 = 0, angle_error_deg = 0;  ///< Zero unless `measured`.
  double texels_per_mm = 0;
  std::uint32_t chart = 0;
  bool measured = false;  ///< Degenerate neither in space nor in uv.
  bool flipped = false, degenerate_3d = false, degenerate_uv = false;
  bool overlaps_chart = false;  ///< Lies over or under a triangle of its own chart.
  bool overlaps_any = false;    ///< ... of any chart of its part.
};

/// Distortion of a map from a surface to the plane. Means are weighted by area in space unless said otherwise;
/// triangles that are degenerate in space or uv are counted, and left out of everything that is made of singular
/// values.
struct DistortionReport {
  std::size_t triangles = 0, measured_triangles = 0;
  std::size_t without_uv = 0;  ///< Left out of everything else.
  std::uint32_t charts = 0;    ///< Connected over edges with the same two positions and uv.
  std::size_t flipped = 0;  ///< Turned against the majority (by uv area) of their chart; not those degenerate in space.
  std::uint32_t mirrored_charts = 0;  ///< Charts whose majority is clockwise in uv (where v runs upwards).
  std::size_t degenerate_3d =
      0;  ///< Doubled area at most 1e-12 of the longest edge squared, or all edges at most 1e-12 of the extent.
  std::size_t degenerate_uv = 0;  ///< The same in uv, of triangles that are not degenerate in space.
  double area_mm2 = 0, uv_area = 0;
  MinMax uv_scale;                   ///< The factors s of the charts that have area.
  double seam_length_mm = 0;         ///< Edges of two or more triangles whose uv differ, each once.
  double seam_phase_jump = 0;        ///< Mean over the seams of |uv jump modulo the texture|, in textures; 0 to √½.
  double overlap_area_fraction = 0;  ///< Area of the plane covered more than once / area covered.
  double overlap_within_charts = 0;  ///< The same counting each chart alone: what matters for tiling textures.
  std::size_t overlapping_triangles = 0, overlapping_within_charts = 0;
  bool has_overlap = true;  ///< MeasureOptions::overlap. When it is false the four above are 0.

  double stretch_l2 = 0;          ///< √(Σ A (σ1⁻² + σ2⁻²) / 2 / Σ A) [Sander et al. 2001]; 1 = isometry.
  double stretch_linf = 0;        ///< max 1/σ2.
  MeanMax symmetric_dirichlet;    ///< σ1² + σ2² + σ1⁻² + σ2⁻²; 4 = isometry.
  MeanMax conformal;              ///< σ1 / σ2; 1 = angles kept.
  MinMeanMax area_ratio;          ///< σ1 σ2; 1 = areas kept.
  MeanMax angle_error_deg;        ///< |angle in uv - angle in space|, mean over the three corners.
  double edge_length_error = 0;   ///< Σ |d - D| / Σ D over the edges, each uv edge once.
  double maillot_length = 0;      ///< Σ (d² - D²)² / D² / Σ D² over the edges [Maillot et al. 1993].
  double maillot_area = 0;        ///< Σ (a - A)² / A / Σ A over the triangles; a signed by the chart's majority.
  double levy_orthogonality = 0;  ///< √ of the mean of (∇u · ∇v)² [Lévy and Mallet 1998].
  double levy_homogeneity =
      0;  ///< √ of the mean over interior edges of the squared jump of ∂u/∂Y and ∂v/∂Y across the edge.
  double green_lagrange =
      0;  ///< Mean over uv area of (σ1⁻² - 1)² + (σ2⁻² - 1)²: the map's first fundamental form against the identity.
  MinMedianMax texel_density;  ///< Texels per mm, uv unscaled; the median by area.

  Percentiles symmetric_dirichlet_percentiles, stretch_percentiles, angle_error_percentiles;
  std::vector<TriangleDistortion> per_triangle;
};

/// Measures any uv from any program.
///
/// Every triangle's map from space to uv is affine; with the singular values σ1 >= σ2 of its Jacobian, after scaling
/// uv as MeasureOptions::normalize says, the report's fields say what is summed.
/// Corners are the same point when positions and uv are equal bit by bit, however they are indexed.
/// Overlap is found exactly (triangle against triangle, contact up to 1e-9 of the edge lengths does not count), so that
/// 0 means none; its area is summed in rows, exact along the row. Shares no code with the solvers. Cost: O(n log n),
/// about 400 bytes per triangle. Parallel, the same bytes for any number of threads.
///
/// @param uv one entry per triangle; those that have no value are counted and left out.
/// @throws InvalidInput when a position or uv is not finite, an index is out of range, or an option is not positive.
DistortionReport measure_distortion(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv,
                                    const MeasureOptions& options = {});

}  // namespace papilla
