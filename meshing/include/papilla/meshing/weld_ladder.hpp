// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "papilla/meshing/weld.hpp"

namespace papilla {

/// What one tolerance of weld() gives.
struct WeldStep {
  double tolerance_mm = 0;
  double seconds = 0;                 ///< Wall time of weld() alone.
  double max_deviation_mm = 0;        ///< The furthest that a vertex moved.
  std::size_t boundary_edges = 0;     ///< Edges of one triangle that are left.
  std::size_t nonmanifold_edges = 0;  ///< Edges of more than two: what welding too much makes.
  std::size_t triangles = 0;          ///< Left; those that a weld collapsed are dropped.
};

/// Error over tolerance of weld(): each tolerance on the same input, in the order given. A good tolerance lies where
/// `boundary_edges` has fallen to a plateau while `max_deviation_mm` is still that of the file's noise; past the next
/// step down real features close. Cost: that of weld() and of counting edges, per tolerance. Deterministic but for the
/// seconds.
/// @param tolerances_mm Finite, not negative. @param options Its tolerances do not matter.
/// @throws InvalidInput as weld(), and when a tolerance is negative or not finite.
std::vector<WeldStep> weld_ladder(const TriangleMesh& mesh, std::span<const double> tolerances_mm,
                                  const WeldOptions& options = {});

}  // namespace papilla
