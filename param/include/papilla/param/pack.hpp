// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "papilla/param/flattening.hpp"

namespace papilla {

// Placing charts. Both functions only translate: grain keeps its direction, its scale and its handedness.

struct PhaseOptions {
  Vec2 tile_mm{0, 0};         ///< Size of the grain's repeat; phases are equal modulo it. 0: no repeat.
  double tolerance_mm = 0.1;  ///< A seam point counts as continued when the texture jumps by no more; above 0.
};

struct AlignedPhase {
  CornerAttribute<Vec2> uv;  ///< Millimetres; charts may lie over one another.
  std::vector<Vec2> offset;  ///< What was added to each chart.
  double seam_mm = 0;        ///< Length of all seams between charts.
  double continued_mm = 0;   ///< Length of the seam over which the grain goes on within tolerance.
  double mean_jump_mm = 0;   ///< Mean of |jump| over the seams, modulo the tile.
};

/// Moves charts so that the grain goes on over their longest continuable seams. For two charts the best translation is
/// the mean of uv_A - uv_B over their common seam; with r the root mean square of what is left and L the seam's length,
/// the pair is worth L / (1 + (r / tolerance)²). Pairs are taken in the order of worth into a spanning forest; one
/// chart of each tree stays where it is. Charts that are turned against one another can't be continued by a
/// translation. Good input: charts whose v axis follows one grain direction, as all flattenings here return. Cost: O(n
/// + s log s) for s seam edges. Deterministic.
/// @param flattening of this mesh.
/// @throws InvalidInput when the flattening does not fit the mesh or an option is out of range.
AlignedPhase align_phase(const TriangleMesh& mesh, const Flattening& flattening, const PhaseOptions& options = {});

struct AtlasOptions {
  double gutter_mm = 1;  ///< Least distance of two charts; at least 0.
  Vec2 tile_mm{0, 0};    ///< When positive, charts move by whole tiles only, so that the phase of tiling grain stays.
};

struct Atlas {
  CornerAttribute<Vec2> uv;  ///< Millimetres, from (0, 0) to size_mm. Divide by the larger side for a unit square.
  std::vector<Vec2> offset;  ///< What was added to each chart.
  Vec2 size_mm;
  double fill_rate =
      0;  ///< Area of the triangles / (larger side of size_mm)², in [0, 1] without overlap in the charts.
};

/// Packs charts into a nearly square rectangle without overlap: bounding boxes, tallest first, at the lowest place of a
/// skyline (bottom left rule), for a few widths, of which the smallest square wins.
/// Guarantees: boxes of different charts are at least gutter_mm apart; no rotation, no mirroring, no scaling.
/// Cost: O(n + c s) for c charts and a skyline of s steps. Deterministic.
/// Source: J. Jylänki, A thousand ways to pack the bin, 2010 (skyline bottom-left).
/// @throws InvalidInput when uv and charts don't fit, or an option is negative or not finite.
Atlas pack_atlas(const CornerAttribute<Vec2>& uv, const ChartSet& charts, const AtlasOptions& options = {});

}  // namespace papilla
