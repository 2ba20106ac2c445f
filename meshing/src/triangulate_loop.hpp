// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::detail {

/// Triangles that fill a closed polygon in space, as indices into it, running the polygon's way round; none when there
/// is no triangulation. Minimises the largest dihedral angle, then the area. O(k^2) mostly, at most O(k^3).
std::vector<Triangle> triangulate_loop(std::span<const Vec3> polygon);

}  // namespace papilla::detail
