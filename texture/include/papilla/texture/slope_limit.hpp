// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/core/trace.hpp"
#include "papilla/texture/height_map.hpp"

namespace papilla {

/// Options of limit_slope().
struct SlopeLimitOptions {
  double max_slope = 1;              ///< s below, millimetres per millimetre, > 0.
  double relative_tolerance = 1e-3;  ///< Of s: how far below s the slopes may be left.
  int iterations = 4000;             ///< At most this many steps.
};

/// What limit_slope() returns.
struct SlopeLimitResult {
  HeightMap relief;
  double steepest_before = 0, steepest_after = 0;  ///< Largest slope.
  double share_before = 0, share_after = 0;        ///< Of the area, steeper than max_slope.
  double rms_change_mm = 0, largest_change_mm = 0;
  int iterations = 0;
  StopReason stop = StopReason::direct;  ///< direct: nothing was too steep, the relief is as it was.
  Trace trace;                           ///< Error: largest slope over s, less 1.
};

/// The relief that is nearest to h among those nowhere steeper than s:
///     min ½ Σ (u − h)²   subject to   |∇u| ≤ s at every sample,
/// ∇ by forward differences, around the seam when the relief is periodic, nothing across other borders. By its dual
///     u = h − div* p,   min over p of ½ |h − div* p|² + s Σ |p|
/// the change of u is the divergence of a flow p that is zero where u is less steep than s: material moves from the top
/// of a steep wall to its foot, and nothing changes elsewhere. So the mean height stays, exactly up to rounding, and so
/// does the volume of every stretch that is surrounded by gentler slopes.
///
/// Fast iterative shrinkage of p [Beck and Teboulle, A fast iterative shrinkage-thresholding algorithm, 2009], started
/// anew when it overshoots [O'Donoghue and Candès, Adaptive restart for accelerated gradient schemes, 2015], with s
/// lowered by the tolerance, until no slope exceeds s. When `stop` is converged, every slope is at most s.
///
/// It breaks sharp walls: a step of height H becomes a ramp of width H/s, details of that size merge, and where a whole
/// relief is steep its range falls. A groove narrower than its depth over s becomes shallower.
/// Cost: about 3 ns a sample and step of one thread; some 10 steps where single samples are too steep, some 300 where
/// walls of ten samples are. Deterministic. Memory: 48 bytes a sample.
/// @throws InvalidInput when the relief is empty, not finite or without pitch, or an option is out of range.
SlopeLimitResult limit_slope(const HeightMap& relief, const SlopeLimitOptions& options);

}  // namespace papilla
