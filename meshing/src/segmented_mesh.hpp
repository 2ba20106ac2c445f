// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "edge_table.hpp"

namespace papilla::detail {

/// A mesh with what segmentation reads of it: edges, opposite half-edges, normals and areas.
struct SegmentedMesh {
  explicit SegmentedMesh(const TriangleMesh& mesh);

  std::span<const Vec3> positions;
  std::span<const Triangle> triangles;
  EdgeTable edges;
  std::vector<Index> opposite;  ///< Per half-edge; k_none at borders.
  std::vector<Vec3> normal;     ///< Per triangle, of length one, or zero when it has no area.
  std::vector<double> area;
  double total_area = 0;

  std::size_t size() const noexcept { return triangles.size(); }
  Vec3 area_vector(Index t) const noexcept { return area[t] * normal[t]; }
  double length(Index h) const noexcept {
    return norm(positions[to_vertex(triangles, h)] - positions[from_vertex(triangles, h)]);
  }
};

/// Renumbers labels 0, 1, ... in the order of their first triangles; returns how many there are.
std::uint32_t renumber(std::vector<std::uint32_t>& labels);

/// Gives every connected piece of every label its own number, in the order of first triangles; returns how many.
std::uint32_t split_into_components(std::span<const Index> opposite, std::vector<std::uint32_t>& labels);

}  // namespace papilla::detail
