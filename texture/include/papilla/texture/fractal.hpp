// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace papilla {

/// One point of a log-log plot: the value of the measure at one scale.
struct ScalePoint {
  double scale = 0;    ///< Side of the box or window, or lag, in pixels.
  double measure = 0;  ///< What the method counts at that scale, in the method's own unit.
};

/// What every estimator of the fractal dimension of a grey picture read as height map returns.
/// D = 3 − H. A picture of a single grey value is a plane: D = 2 with an interval of width 0. best_dimension() stays
/// within [2, 3]; the others may leave it on pictures that are no fractal surface, and then state no dimension.
struct FractalEstimate {
  double dimension = 2;
  double hurst = 1;               ///< 3 − dimension; outside [0, 1] when the picture is no fractal surface.
  double low = 2, high = 2;       ///< 95 % interval, within [2, 3] where the dimension is; each method says whence.
  std::vector<ScalePoint> curve;  ///< The points of the log-log plot, by rising scale.

  /// Within [2, 3], as the dimension of a surface is.
  bool is_of_surface() const noexcept { return dimension >= 2 && dimension <= 3; }
};

}  // namespace papilla
