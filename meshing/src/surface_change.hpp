// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::detail {

struct SurfaceChangeOptions {
  double least_altitude_mm = 0;  ///< Flatter triangles of `before` are no surface.
  double reach_mm = 0;           ///< The largest change that is expected; larger ones may be overstated.
  double floor_mm = 0;           ///< Smaller distances need not be told apart. Above 0.
  std::size_t sample_above = 0;  ///< Surfaces of more triangles are measured by samples.
};

struct SurfaceChange {
  double lost_mm = 0;    ///< No point of the surface before is farther from the one after.
  double added_mm = 0;   ///< No point of the surface after is farther from the one before.
  bool sampled = false;  ///< Both are the largest met at about 4000 places instead.
};

/// How far a surface moved, both ways: surface_deviation() of the triangles that are not the same before and after.
/// Samples are spread evenly over the list of triangles and compared with those triangles that come within `reach_mm`
/// of their cells of a grid, so that no tree over all of them is needed.
/// Cost: O(n) to find what is the same, then 2 us a triangle that is not; sampled about 30 ns a triangle.
/// Deterministic.
/// @param before With indices in range and positions within check_distance_input()'s limit. @param triangles Of
/// `before`: those that count.
SurfaceChange surface_change(const TriangleMesh& before, std::span<const Index> triangles, const TriangleMesh& after,
                             const SurfaceChangeOptions& options);

}  // namespace papilla::detail
