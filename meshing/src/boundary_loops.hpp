// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edge_table.hpp"

namespace papilla::detail {

/// The boundary half-edges of an oriented mesh in the order of walking along them, loop by loop; loops begin with their
/// smallest half-edge and come in that order. Loops through a vertex where several borders meet are left out.
std::vector<std::vector<Index>> simple_boundary_loops(const std::vector<Triangle>& triangles, std::size_t vertex_count,
                                                      const EdgeTable& edges);

}  // namespace papilla::detail
