// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/core/deadline.hpp"
#include "papilla/param/chart_memory.hpp"
#include "papilla/param/flattening.hpp"
#include "papilla/param/triplanar.hpp"

namespace papilla {

/// Well-known maps as CGAL computes them, to compare with.
enum class ReferenceMap {
  tutte,       ///< Barycentric with uniform weights, border on a circle [Tutte 1963].
  mean_value,  ///< Floater's mean value coordinates, border on a circle [Floater 2003].
  arap,        ///< As rigid as possible, free border [Liu et al. 2008].
};

struct ReferenceOptions {
  UpAxis up = UpAxis::z;
  ReferenceMap map = ReferenceMap::arap;
  double arap_lambda = 1000;      ///< CGAL's λ: 0 keeps angles, larger values keep lengths; not negative.
  int arap_iterations = 50;       ///< At most; at least 1.
  double arap_tolerance = 1e-6;   ///< Relative change of the energy at which ARAP stops; 0 or more.
  Deadline deadline;              ///< Charts not begun by then are projected; one that is begun is finished.
  ChartMemory* memory = nullptr;  ///< Charts that it has are not mapped again.
  bool fall_back = true;          ///< What a chart without a valid map gets: as in LscmOptions.
  TriplanarOptions projection;    ///< Of the fallback; its `up` is taken from here.
};

/// Maps every chart with CGAL, scales it so that its uv area is its area in space (mm²), and turns it so that v follows
/// grain_direction() on the area average.
///
/// Guarantees: what Flattening promises; charts that CGAL maps with a flip or an overlap fall back. Tutte and mean
/// value maps are valid on disks without holes and of moderate curvature, up to rounding; ARAP flips triangles of
/// strongly curved charts. Cost: CGAL's; flatten_best() is faster and better than each. Trace: one sample, error = mean
/// symmetric Dirichlet energy Σ A (σ1² + σ2² + σ1⁻² + σ2⁻²) / Σ A of the charts that have a map; none where it is
/// infinite, which one triangle without area can do.
///
/// @param charts one number below charts.count for every triangle.
/// @throws InvalidInput for a mesh, chart set or option that breaks these preconditions; without fall_back also for a
///         chart of the wrong topology, naming chart and triangle; SolverFailure for one that has no valid map.
Flattening flatten_reference(const TriangleMesh& mesh, const ChartSet& charts, const ReferenceOptions& options = {});

}  // namespace papilla
