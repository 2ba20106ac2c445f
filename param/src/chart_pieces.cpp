// SPDX-License-Identifier: MIT
#include "chart_pieces.hpp"

#include <algorithm>
#include "papilla/core/union_find.hpp"

namespace papilla::param_detail {
TrianglesOfCharts sort_by_chart(const std::vector<std::uint32_t>& chart_of_triangle, std::uint32_t count) {
  TrianglesOfCharts result;
  result.first.assign(std::size_t{count} + 2, 0);
  for (const std::uint32_t chart : chart_of_triangle) ++result.first[std::size_t{chart} + 2];
  for (std::size_t c = 2; c < result.first.size(); ++c) result.first[c] += result.first[c - 1];
  result.triangles.resize(chart_of_triangle.size());
  for (std::size_t t = 0; t < chart_of_triangle.size(); ++t)
    result.triangles[result.first[std::size_t{chart_of_triangle[t]} + 1]++] = static_cast<Index>(t);
  result.first.pop_back();
  return result;
}

double seam_length(const TriangleMesh& mesh, const Adjacency& across, const std::vector<std::uint32_t>& chart) {
  double length = 0;
  for (std::size_t h = 0; h < across.size(); ++h) {
    const std::size_t t = h / 3;
    if (across[h] == k_no_triangle || across[h] < t || chart[across[h]] == chart[t]) continue;
    const int k = static_cast<int>(h % 3);
    length += norm(mesh.corner(t, (k + 1) % 3) - mesh.corner(t, k));
  }
  return length;
}

ChartSurface ChartCutter::cut(std::uint32_t chart, std::span<const Index> triangles) const {
  ChartSurface surface;
  surface.triangles.resize(triangles.size());
  surface.across.assign(triangles.size(), {k_no_triangle, k_no_triangle, k_no_triangle});
  UnionFind corners_of_vertex(3 * triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const std::size_t t = triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const Index other = (*across_)[3 * t + k];
      if (other == k_no_triangle || charts_->of_triangle[other] != chart) continue;
      surface.across[i][k] = local_[other];
      if (other < t) continue;
      const Index start = mesh_->triangles[t][k];
      const Triangle& corners = mesh_->triangles[other];
      // The edge runs the other way in the neighbour: its corner after the end is the start.
      for (std::size_t m = 0; m < 3; ++m) {
        if (corners[(m + 1) % 3] != start || corners[m] != mesh_->triangles[t][(k + 1) % 3]) continue;
        const auto base = 3 * local_[other];
        corners_of_vertex.unite(static_cast<Index>(3 * i + k), static_cast<Index>(base + (m + 1) % 3));
        corners_of_vertex.unite(static_cast<Index>(3 * i + (k + 1) % 3), static_cast<Index>(base + m));
      }
    }
  }
  Index vertices = 0;
  const std::vector<Index> number = corners_of_vertex.labels(vertices);
  for (Index c = 0; c < number.size(); ++c) {
    if (number[c] == surface.positions.size())
      surface.positions.push_back(mesh_->corner(triangles[c / 3], static_cast<int>(c % 3)));
    surface.triangles[c / 3][c % 3] = number[c];
  }
  return surface;
}

}  // namespace papilla::param_detail
