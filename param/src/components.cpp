// SPDX-License-Identifier: MIT
#include "papilla/param/components.hpp"

#include "adjacency.hpp"
#include "check_mesh.hpp"
#include "sheets.hpp"

namespace papilla {

ChartSet components_as_charts(const TriangleMesh& mesh) {
  param_detail::check_mesh(mesh, "components_as_charts");
  // Sheets of equal label: with one label for all, the components.
  param_detail::Sheets sheets = param_detail::connect_sheets(param_detail::connect_triangles(mesh),
                                                             std::vector<std::uint8_t>(mesh.triangles.size(), 0));
  return {std::move(sheets.of_triangle), sheets.count, 0};
}

}  // namespace papilla
