// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/core/trace.hpp"
#include "papilla/core/vec.hpp"
#include "photograph_gains.hpp"

namespace papilla::texture_detail {

struct UnknownLights {
  std::vector<Vec3> lights;  ///< Length 1.
  double uncertainty_deg = 0;
  Trace trace;  ///< Root mean square of rank and integrability residuals after every step.
  StopReason stop = StopReason::iteration_limit;
};

/// Lights of flattened photographs of mean 1 up to convex and concave; see photometric_stereo().
UnknownLights estimate_lights(const Photographs& photographs);

}  // namespace papilla::texture_detail
