// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Whether the edge from corner k to the next one belongs to that triangle alone, by indices. Triangles without values
/// (k_no_value) have no edges. O(n log n).
std::vector<std::array<bool, 3>> border_edges(std::span<const Triangle> triangles);

}  // namespace papilla
