// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::detail {

/// Numbers of the distinct positions that a triangle list names, in the order of the positions.
struct ExactPositions {
  std::vector<Index> of_position;  ///< Position -> number; k_none when no triangle names it.
  std::vector<Index> first;        ///< Number -> the first position that has it.
};

/// Two positions are the same when all coordinates compare equal (so -0 is 0). O(n) expected; deterministic.
ExactPositions exact_positions(const TriangleMesh& mesh);

}  // namespace papilla::detail
