// SPDX-License-Identifier: MIT
#include "papilla/param/components.hpp"

#include <algorithm>
#include <string>
#include <tuple>

#include "adjacency.hpp"
#include "check_mesh.hpp"
#include "papilla/core/error.hpp"
#include "sheets.hpp"

namespace papilla {

ChartSet components_as_charts(const TriangleMesh& mesh) {
  param_detail::check_mesh(mesh, "components_as_charts");
  // Sheets of equal label: with one label for all, the components.
  param_detail::Sheets sheets = param_detail::connect_sheets(param_detail::connect_triangles(mesh),
                                                             std::vector<std::uint8_t>(mesh.triangles.size(), 0));
  return {std::move(sheets.of_triangle), sheets.count, 0};
}

void require_manifold(const TriangleMesh& mesh) {
  constexpr const char* k_function = "require_manifold";
  param_detail::check_mesh(mesh, k_function);
  struct Side {
    Index low, high, triangle;
    bool forward;
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (Index t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& r) {
    return std::tie(s.low, s.high, s.triangle) < std::tie(r.low, r.high, r.triangle);
  });
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
    const bool manifold = end - i == 1 || (end - i == 2 && sides[i].forward != sides[i + 1].forward);
    if (!manifold)
      throw InvalidInput("edge (" + std::to_string(sides[i].low) + ", " + std::to_string(sides[i].high) +
                         ") of triangle[" + std::to_string(sides[i].triangle) + "] " +
                         (end - i == 2 ? "runs the same way in triangle[" + std::to_string(sides[i + 1].triangle) + "]"
                                       : "has " + std::to_string(end - i) + " triangles") +
                         "; repair parts such edges");
    i = end;
  }
}

}  // namespace papilla
