// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "wedge_mesh.hpp"

namespace papilla::detail {

struct DecimateOptions {
  std::size_t target_triangles = 0;
  double error_mm = 0;  ///< Largest mean plane distance of a collapse, as the library counts it.
  bool lock_border = false;
};

/// Edge collapses onto existing vertices by quadric error, done by libmeshoptimizer on `indices`, triangles between
/// wedges; returns what remains. @param locked Per position, or empty: vertices to keep.
std::vector<Index> decimate(const WedgeMesh& wedges, const std::vector<Index>& indices,
                            const std::vector<std::uint8_t>& locked, const DecimateOptions& options);

}  // namespace papilla::detail
