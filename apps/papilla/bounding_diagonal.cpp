// SPDX-License-Identifier: GPL-3.0-or-later
#include "bounding_diagonal.hpp"

#include <algorithm>

namespace papilla::app {

double bounding_diagonal_mm(const TriangleMesh& mesh) {
  if (mesh.positions.empty()) return 0;
  Vec3 low = mesh.positions.front(), high = low;
  for (const Vec3& p : mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return norm(high - low);
}

}  // namespace papilla::app
