// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "papilla/core/bounds.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::detail {

/// Adds the positions that triangles name to `bounds`. Throws InvalidInput naming `what` and the index when a
/// triangle names a position that does not exist, or one that is not finite or beyond 1e15 mm, beyond which single
/// precision boxes of size ratios overflow.
void check_distance_input(const TriangleMesh& mesh, std::string_view what, Bounds3& bounds);

}  // namespace papilla::detail
