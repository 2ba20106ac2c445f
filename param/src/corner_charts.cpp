// SPDX-License-Identifier: MIT
#include "corner_charts.hpp"

#include "adjacency.hpp"
#include "chart_pieces.hpp"
#include "papilla/core/union_find.hpp"

namespace papilla::param_detail {

CornerCharts charts_of_corners(const TriangleMesh& mesh, const std::vector<CornerUv>& uv,
                               const std::vector<std::uint32_t>& label) {
  const std::size_t count = mesh.triangles.size();
  CornerCharts result;
  std::vector<char> over(count);
  for (std::size_t t = 0; t < count; ++t) {
    over[t] = cross(uv[t][1] - uv[t][0], uv[t][2] - uv[t][0]) < 0;
    result.turned_over += over[t] != 0;
  }
  const Adjacency across = connect_triangles(mesh);
  UnionFind triangles(count), corners(3 * count);
  for (Index t = 0; t < count; ++t)
    for (Index k = 0; k < 3; ++k) {
      const Index other = across[3 * t + k], l = (k + 1) % 3;
      if (other == k_no_triangle || other < t || label[t] != label[other] || over[t] != over[other]) continue;
      // The edge runs the other way in the neighbour.
      for (Index m = 0; m < 3; ++m) {
        const Index n = (m + 1) % 3;
        if (mesh.triangles[other][m] != mesh.triangles[t][l] || mesh.triangles[other][n] != mesh.triangles[t][k])
          continue;
        if (uv[t][l] != uv[other][m] || uv[t][k] != uv[other][n]) continue;
        triangles.unite(t, other);
        corners.unite(3 * t + l, 3 * other + m);
        corners.unite(3 * t + k, 3 * other + n);
      }
    }
  Flattening& f = result.flattening;
  f.uv.indices.resize(count);
  f.charts.of_triangle.resize(count);
  std::vector<Index> number(3 * count, k_no_triangle);
  for (Index c = 0; c < 3 * count; ++c) {
    Index& own = number[corners.find(c)];
    if (own == k_no_triangle) {
      own = static_cast<Index>(f.uv.values.size());
      const Vec2 p = uv[c / 3][c % 3];
      f.uv.values.push_back(over[c / 3] ? Vec2{-p.x, p.y} : p);
    }
    f.uv.indices[c / 3][c % 3] = own;
  }
  for (Index t = 0; t < count; ++t) {
    const Index first = triangles.find(t);
    f.charts.of_triangle[t] = first == t ? f.charts.count++ : f.charts.of_triangle[first];
  }
  f.charts.seam_length_mm = seam_length(mesh, across, f.charts.of_triangle);
  return result;
}

}  // namespace papilla::param_detail
