// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "papilla/meshing/simplify.hpp"

namespace papilla {

/// What one tolerance of simplify() gives.
struct SimplifyStep {
  double tolerance_mm = 0;
  double seconds = 0;  ///< Wall time of simplify(), measuring included.
  std::size_t triangles = 0;
  double deviation_mm = 0, deviation_bound_mm = 0;  ///< Measured on the result.
  StopReason stop = StopReason::converged;
  Trace trace;  ///< SimplifyResult::trace.
};

/// Triangles and deviation over tolerance and run time of simplify(): each tolerance on the same input, in the order
/// given. Cost: that of simplify(), per tolerance. Deterministic but for the seconds.
/// @param options Its tolerance and target do not matter. @throws InvalidInput as simplify().
std::vector<SimplifyStep> simplify_ladder(const TriangleMesh& mesh, std::span<const double> tolerances_mm,
                                          const SimplifyOptions& options = {});

}  // namespace papilla
