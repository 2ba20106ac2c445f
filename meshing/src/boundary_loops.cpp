// SPDX-License-Identifier: MIT
#include "boundary_loops.hpp"

#include <algorithm>
#include <utility>

namespace papilla::detail {
namespace {

constexpr Index k_several = k_none - 1;

/// The boundary half-edge that leaves each vertex; k_none or k_several when there isn't exactly one.
std::vector<Index> leaving_halfedges(const std::vector<Triangle>& triangles, std::size_t vertex_count,
                                     const std::vector<Index>& boundary) {
  std::vector<Index> leaving(vertex_count, k_none);
  for (const Index h : boundary) {
    Index& first = leaving[from_vertex(triangles, h)];
    first = first == k_none ? h : k_several;
  }
  return leaving;
}

}  // namespace

std::vector<std::vector<Index>> simple_boundary_loops(const std::vector<Triangle>& triangles, std::size_t vertex_count,
                                                      const EdgeTable& edges) {
  std::vector<Index> boundary = edges.boundary_halfedges();
  if (boundary.empty()) return {};
  const std::vector<Index> leaving = leaving_halfedges(triangles, vertex_count, boundary);
  std::sort(boundary.begin(), boundary.end());
  std::vector<std::uint8_t> seen(3 * triangles.size(), 0);
  std::vector<std::vector<Index>> loops;
  for (const Index start : boundary) {
    if (seen[start]) continue;
    std::vector<Index> loop;
    Index h = start;
    while (h < k_several && !seen[h]) {
      seen[h] = 1;
      loop.push_back(h);
      h = leaving[to_vertex(triangles, h)];
    }
    if (h == start) loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace papilla::detail
