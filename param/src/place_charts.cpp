// SPDX-License-Identifier: MIT
#include "place_charts.hpp"

#include <string>

#include "check_mesh.hpp"
#include "papilla/core/error.hpp"

namespace papilla::param_detail {

CornerAttribute<Vec2> move_charts(const CornerAttribute<Vec2>& uv, const ChartSet& charts,
                                  const std::vector<Vec2>& offset, std::string_view function) {
  constexpr std::uint32_t no_owner = ~std::uint32_t{0};
  std::vector<std::uint32_t> owner(uv.values.size(), no_owner);
  CornerAttribute<Vec2> moved = uv;
  for (std::size_t t = 0; t < uv.indices.size(); ++t)
    for (const Index i : uv.indices[t]) {
      const std::uint32_t chart = charts.of_triangle[t];
      if (owner[i] == chart) continue;
      if (owner[i] != no_owner)
        throw InvalidInput(std::string(function) + ": uv[" + std::to_string(i) + "] belongs to chart[" +
                           std::to_string(owner[i]) + "] and chart[" + std::to_string(chart) + "]");
      owner[i] = chart;
      moved.values[i] = uv.values[i] + offset[chart];
    }
  return moved;
}

void check_flattening(const CornerAttribute<Vec2>& uv, const ChartSet& charts, std::string_view function) {
  TriangleMesh triangles_only;
  triangles_only.triangles.resize(charts.of_triangle.size());
  check_charts(triangles_only, charts, function);
  check_uv(triangles_only, uv, function);
}

}  // namespace papilla::param_detail
