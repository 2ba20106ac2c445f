// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <string_view>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::detail {

struct Bounds {
  Vec3 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
           std::numeric_limits<double>::infinity()};
  Vec3 high = -low;

  void add(const Vec3& p) noexcept;
  /// Length of the diagonal; 0 when nothing was added.
  double diagonal() const noexcept { return low.x <= high.x ? norm(high - low) : 0; }
};

/// Adds the positions that triangles name to `bounds`. Throws InvalidInput naming `what` and the index when a
/// triangle names a position that does not exist, or one that is not finite or beyond 1e15 mm, beyond which single
/// precision boxes of size ratios overflow.
void check_distance_input(const TriangleMesh& mesh, std::string_view what, Bounds& bounds);

}  // namespace papilla::detail
