// SPDX-License-Identifier: MIT
#include "segmented_mesh.hpp"

#include <algorithm>

#include "papilla/core/union_find.hpp"

namespace papilla::detail {

SegmentedMesh::SegmentedMesh(const TriangleMesh& mesh)
    : positions(mesh.positions),
      triangles(mesh.triangles),
      edges(mesh.triangles, mesh.positions.size()),
      opposite(opposite_halfedges(mesh.triangles, edges)) {
  normal.reserve(triangles.size());
  area.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    const Vec3 vector = 0.5 * detail::area_vector(positions[t[0]], positions[t[1]], positions[t[2]]);
    area.push_back(norm(vector));
    normal.push_back(normalized(vector));
    total_area += area.back();
  }
}

std::uint32_t renumber(std::vector<std::uint32_t>& labels) {
  std::uint32_t largest = 0;
  for (const std::uint32_t label : labels) largest = std::max(largest, label);
  std::vector<std::uint32_t> number(labels.empty() ? 0 : std::size_t{largest} + 1, k_none);
  std::uint32_t count = 0;
  for (std::uint32_t& label : labels) {
    if (number[label] == k_none) number[label] = count++;
    label = number[label];
  }
  return count;
}

std::uint32_t split_into_components(std::span<const Index> opposite, std::vector<std::uint32_t>& labels) {
  UnionFind sets(labels.size());
  for (Index h = 0; h < opposite.size(); ++h) {
    if (opposite[h] == k_none || opposite[h] < h) continue;
    const Index a = triangle_of(h), b = triangle_of(opposite[h]);
    if (labels[a] == labels[b]) sets.unite(a, b);
  }
  Index count = 0;
  labels = sets.labels(count);
  return count;
}

}  // namespace papilla::detail
