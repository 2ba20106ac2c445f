// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "papilla/core/bounds.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::detail {

/// Triangles that hang together by vertices.
struct Components {
  std::vector<Index> begin;      ///< Of each one in `triangles`, and the end of the last.
  std::vector<Index> triangles;  ///< Ascending within each; components in the order of their smallest vertices.

  std::size_t size() const noexcept { return begin.size() - 1; }
  std::span<const Index> of(std::size_t c) const noexcept {
    return std::span(triangles).subspan(begin[c], begin[c + 1] - begin[c]);
  }
};

Components connected_triangles(const TriangleMesh& mesh);

/// The box around some triangles of a mesh.
Bounds3 bounds_of(const TriangleMesh& mesh, std::span<const Index> triangles);

/// Parts boxes into sets so that no box, grown by `margin`, overlaps one of another set. Where that would be more than
/// some hundred sets, some are one. Returns the numbers that came with the boxes. O(n) for n boxes.
std::vector<std::vector<std::size_t>> parted_by_boxes(const std::vector<std::pair<std::size_t, Bounds3>>& boxes,
                                                      double margin);

}  // namespace papilla::detail
