// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "papilla/core/progress.hpp"
#include "papilla/meshing/chart_set.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Options of segment_charts(). All are relative, so one set of values serves any size of part.
struct SegmentationOptions {
  double feature_angle_deg = 45;         ///< Edges bent more than this part charts; in (0, 180].
  double max_normal_deviation_deg = 60;  ///< Half-angle of the cone that holds a chart's normals; in (0, 180].
  double outlier_area_fraction = 0.01;   ///< Of a chart's area may lie outside its cone: noise, not shape; in [0, 1].
  double small_area_fraction = 1e-3;     ///< A chart below this fraction of a neighbour's area joins it; in [0, 1].
  double speck_area_fraction =
      1e-5;           ///< A chart below this fraction of its component's area joins its longest
                      ///< neighbour whatever that one's size, which bounds the number of charts; in [0, 1].
  bool disks = true;  ///< Cut charts until each is a disk.
  Progress progress;  ///< Told the fraction done; may be empty.
};

struct SegmentationResult {
  ChartSet charts;
  std::size_t feature_patches = 0;  ///< Pieces between feature edges.
  std::size_t cone_charts = 0;      ///< Charts after splitting by normals and merging what fits.
  std::size_t absorbed = 0;         ///< Small charts that joined a neighbour.
  std::size_t disk_cuts = 0;        ///< Bisections that made disks.
};

/// Splits a mesh into charts for texturing. Between feature edges, patches are bisected by two-means of their normals
/// (best-first region growing, as in [Cohen-Steiner, Alliez, Desbrun 2004], "Variational shape approximation") until
/// all but `outlier_area_fraction` of each lies within a cone of normals, so that a chart is nearly a height field;
/// neighbours whose union fits the cone are merged again, and slivers join their longest neighbour. Then every chart
/// that is no disk is cut in two along the shortest paths that join its border loops, opposite those paths (one with
/// handles: half way between its farthest triangles), until all are disks. As measures are areas and angles, the number
/// of charts follows the shape, not the tessellation.
///
/// Guarantees: every triangle in exactly one chart, chart numbers in the order of their first triangles, every chart
/// connected; with `disks`, every chart a topological disk in the sense of ChartTopology. The cone holds except where a
/// surface is rougher than that at every scale, or a small chart joined.
/// Good input is repaired: welded by index, manifold and oriented; edges that are not count as borders.
/// Cost: O(n log n) for a bounded number of charts. Deterministic.
/// @throws InvalidInput when an index is out of range, a position is not finite or an option is out of range.
SegmentationResult segment_charts(const TriangleMesh& mesh, const SegmentationOptions& options = {});

}  // namespace papilla
