// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/core/vec.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Options of surface_deviation().
struct DeviationOptions {
  bool two_sided = true;  ///< Also from the second surface to the first.

  /// The maximum is settled when bound - value <= max(relative_tolerance * value, absolute_tolerance_mm).
  double relative_tolerance = 0.01;   ///< >= 0.
  double absolute_tolerance_mm = -1;  ///< Negative: 1e-6 of the bounding diagonal of both surfaces.

  /// Distances below this need no settling and are not searched for, so that `value` misses them: "within the
  /// tolerance?" is answered by bound <= tolerance at a fraction of the cost. 0: settle everything.
  double settled_below_mm = 0;

  /// List the triangles that exceed this, and refine none of them further, so that `bound` is loose where the list
  /// is not empty. Infinity: none.
  double list_above_mm = std::numeric_limits<double>::infinity();

  std::uint64_t mean_samples = 200'000;  ///< Of mean and rms, area-weighted; at least one a triangle. 0: leave them 0.
  std::uint32_t pieces_per_triangle = 20'000;  ///< Refinement limit of one triangle (plus 32 a triangle of the
                                               ///< other surface); what is left counts in the bound.
  ProgressCallback progress = {};              ///< Told the fraction of a side; may be empty.
};

/// A triangle found to exceed DeviationOptions::list_above_mm, with the largest distance met on it.
struct ExceedingTriangle {
  Index triangle = k_no_value;          ///< Of the surface measured.
  Index nearest_triangle = k_no_value;  ///< Of the other surface: closest to `at`.
  double value = 0;                     ///< At most `list_above_mm` when only the bound exceeds it.
  Vec3 at;
};

/// The distances of one surface's points to another surface, in mm.
struct OneSidedDeviation {
  double value = 0;                      ///< The largest distance met: a lower bound of the maximum, attained at `at`.
  double bound = 0;                      ///< No point of the surface is farther away than this.
  double mean = 0, rms = 0;              ///< Over the area, by sampling; triangles of no area do not count.
  Vec3 at, nearest;                      ///< Where `value` is attained, and a closest point on the other surface.
  Index triangle = k_no_value;           ///< The triangle that `at` lies on.
  std::vector<ExceedingTriangle> above;  ///< Triangles that exceed `list_above_mm`, in their order.
  std::uint64_t unsettled = 0;           ///< Triangles whose refinement hit its limit.
};

struct DeviationResult {
  OneSidedDeviation from_to;
  OneSidedDeviation to_from;  ///< All zero unless two-sided.
  double value() const noexcept { return from_to.value > to_from.value ? from_to.value : to_from.value; }
  double bound() const noexcept { return from_to.bound > to_from.bound ? from_to.bound : to_from.bound; }
};

/// How far two triangle surfaces are apart: max over p in `from` of d(p, to), d(p, to) = min over q in `to` of |p - q|,
/// and with `two_sided` the same with the surfaces swapped (the maximum of both is the Hausdorff distance).
///
/// Measured, not estimated: `value` is attained by a point of the surface, and `bound` is an upper bound over *all*
/// points of all triangles, both up to rounding (about 1e-15 of the largest coordinate; beside needles of aspect 1e5
/// and more up to 1e-9 of it). A piece F of a triangle, a
/// convex polygon, is bounded by max over its corners v of d(v, S) for a triangle S of `to`, since the distance to a
/// convex set is a convex function, and by d(m) + max |v - m| from its centre m, since d is 1-Lipschitz. Where both
/// exceed the present maximum, F is cut along the prism over its closest triangle S, within which the first bound is
/// exact, or halved when that cut has no inside. So large flat triangles against a fine tessellation, the usual case
/// after simplification, cost one piece per triangle overlapped instead of one per tolerance squared.
///
/// Guarantees: value <= maximum <= bound; bound - value within the tolerances unless `unsettled` > 0 or
/// `settled_below_mm` is set; triangles of any shape, also needles and points; neither welded nor manifold nor oriented
/// input is needed, and unused positions are ignored. Not a signed distance: sheets that lie in each other are close.
/// Same result for any number of threads.
/// Cost: O((n + m) log(n + m)) for surfaces that follow each other, about 2 us a triangle and side on one core.
/// @throws InvalidInput when exactly one surface has no triangles, when an index is out of range, or a coordinate is
///         not finite or beyond 1e15 mm, or an option is negative or not a number; Cancelled.
/// The convexity bound is that of Tang, Lee and Kim, Interactive Hausdorff Distance Computation for General Polygonal
/// Models, SIGGRAPH 2009; cutting along the prisms instead of halving is ours.
DeviationResult surface_deviation(const TriangleMesh& from, const TriangleMesh& to,
                                  const DeviationOptions& options = {});

}  // namespace papilla
