// SPDX-License-Identifier: MIT
#include "check_distance_input.hpp"

#include <cmath>
#include <string>

#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"

namespace papilla::detail {

void check_distance_input(const TriangleMesh& mesh, std::string_view what, Bounds3& bounds) {
  constexpr double k_largest = 1e15;
  const auto usable = [](double x) { return std::abs(x) <= k_largest; };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const Index v : mesh.triangles[t]) {
      if (v >= mesh.positions.size())
        throw InvalidInput(std::string(what) + ".triangles[" + std::to_string(t) + "]: there is no position " +
                           std::to_string(v));
      const Vec3& p = mesh.positions[v];
      if (!usable(p.x) || !usable(p.y) || !usable(p.z))
        throw InvalidInput(std::string(what) + ".positions[" + std::to_string(v) + "]: not finite or beyond 1e15 mm");
      bounds.add(p);
    }
}

}  // namespace papilla::detail
