// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/param/flattening.hpp"

namespace papilla {

struct UniqueAtlasOptions {
  int texture_px = 2048;  ///< Side of the square texture; 16 to 65536.
  double gutter_px = 4;   ///< Least distance of two charts in texels; half of it to the texture's edge. 0 to a quarter
                          ///< of texture_px.
  /// Relative texel density per chart, above 0; empty: the same for all.
  std::vector<double> density = {};
};

struct UniqueAtlas {
  CornerAttribute<Vec2> uv;  ///< In [0, 1].
  double fill_rate = 0;      ///< Area of the triangles in the texture, in [0, 1] without overlap in the charts.
  double texels_per_mm = 0;  ///< Of charts of density 1.
  double gutter_px = 0;      ///< What was kept; at least what was asked for.
};

/// Packs charts into one square texture in which no texel belongs to two of them: for ageing, light and normal maps
/// that are baked per place, where the grain's direction does not matter. Charts are turned by quarter turns and
/// scaled by one factor (times their density), never mirrored.
///
/// Every chart is two outlines over the columns of a grid, its lower and its upper one. Tallest first, each goes where
/// its upper outline ends lowest, and among such places where it leaves least room below [Lévy, Petitjean, Ray,
/// Maillot 2002]; a few widths are tried, of which the smallest square wins.
/// Guarantees: charts are gutter_px apart (in the larger of both directions), inside of the texture by half of it.
/// Breaks down: holes in charts are not used; charts that spread like ribs leave their gaps empty. Cost: O(n) per width
/// plus at most 10⁶ steps per chart, less for many charts. Deterministic.
/// @param uv in one unit, of any scale; a value belongs to one chart.
/// @throws InvalidInput when uv and charts don't fit, or an option is out of range, or the gutters leave no room.
UniqueAtlas pack_unique(const CornerAttribute<Vec2>& uv, const ChartSet& charts,
                        const UniqueAtlasOptions& options = {});

}  // namespace papilla
