// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/param/best.hpp"
#include "papilla/param/chart_choice.hpp"
#include "papilla/param/flattening.hpp"

namespace papilla {

/// Options of flatten_automatic(). Angles apart, all is dimensionless.
struct AutomaticOptions {
  UpAxis up = UpAxis::z;
  /// A chart may be developable when the angles around no interior vertex miss 2π by more; in degrees, in [0, 360].
  double developable_deg = 0.05;
  /// It is when its conformal map has a mean symmetric Dirichlet energy of at most 4 plus this; at least 0.
  double developable_excess = 1e-6;
  /// A chart is nearly flat when no normal is farther from the mean one; in degrees, in [0, 60].
  /// 8° shorten lengths by 1 % at most.
  double flat_deg = 8;
  BestOptions best;  ///< For all other charts; its `up` is taken from here.
};

struct AutomaticResult {
  Flattening flattening;             ///< Trace: as of flatten_best().
  std::vector<ChartChoice> choices;  ///< One for every chart that has triangles, in order.
};

/// Maps every chart by the cheapest method that does it well:
///     developable (angles around all interior vertices add up to 2π)  ->  exact: the least squares conformal map,
///     which
///         is then an isometry up to rounding, and is checked to be one;
///     nearly flat (normals within flat_deg of their mean)             ->  planar: projection along the mean normal;
///     else, and where one of these overlaps or flips                  ->  best: flatten_best().
/// Guarantees: what Flattening and flatten_best() promise, for every choice. Breaks down: as flatten_best(); charts of
/// noisy scans are never developable. Cost: O(n) for the choice and for planar, one factorization for exact.
/// Deterministic, whatever the number of threads.
///
/// @param charts one number below charts.count for every triangle.
/// @throws as flatten_best(), and InvalidInput for an angle out of range.
AutomaticResult flatten_automatic(const TriangleMesh& mesh, const ChartSet& charts,
                                  const AutomaticOptions& options = {});

}  // namespace papilla
