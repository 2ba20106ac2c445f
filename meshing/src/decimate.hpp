// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/core/deadline.hpp"
#include "wedge_mesh.hpp"

namespace papilla::detail {

struct DecimateOptions {
  std::size_t target_triangles = 0;
  double error_mm = 0;  ///< Largest root of a collapse's quadric: no plane it stood for is passed by more than this.
  bool lock_border = false;
  Deadline deadline;  ///< Collapses after it are left out.
  /// What the squared length of a collapse counts for in the order, beside its error: little, and of equal errors short
  /// ones come first; much, and edges become even.
  double length_weight = 1e-8;
};

/// Half-edge collapses in the order of quadric error [Garland and Heckbert, Surface simplification using quadric error
/// metrics, SIGGRAPH 1997]: a place moves onto a neighbour, each of its wedges onto the neighbour's wedge across
/// their common edge. The quadric of a place sums the squared distances to the planes of its triangles and, along
/// creases, to the planes upright on them. A crease is an edge that is not smooth (WedgeMesh): a place without one
/// moves to any neighbour, one on a crease with two ends moves along it, every other stays. Collapses that would change
/// the topology or turn a triangle by more than 75 degrees are left out. Double precision throughout. Deterministic,
/// serial, O(n log n).
/// @param indices Triangles between wedges. @param kept Per place, or empty: places to keep.
std::vector<Index> decimate(const WedgeMesh& wedges, const std::vector<Index>& indices,
                            const std::vector<std::uint8_t>& kept, const DecimateOptions& options);

}  // namespace papilla::detail
