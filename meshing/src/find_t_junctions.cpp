// SPDX-License-Identifier: MIT
#include "find_t_junctions.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <span>
#include <tuple>

#include "point_tree.hpp"

namespace papilla::detail {
namespace {

constexpr std::size_t k_edges_per_task = 4096;

std::vector<Index> end_vertices(std::span<const Triangle> triangles, const std::vector<Index>& halfedges) {
  std::vector<Index> vertices;
  vertices.reserve(2 * halfedges.size());
  for (const Index h : halfedges) {
    vertices.push_back(from_vertex(triangles, h));
    vertices.push_back(to_vertex(triangles, h));
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

}  // namespace

std::vector<TJunction> find_t_junctions(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                        const EdgeTable& edges, double reach, double from_ends) {
  const std::vector<Index> boundary = edges.boundary_halfedges();
  if (boundary.empty()) return {};
  const PointTree tree(positions, end_vertices(triangles, boundary));

  const auto visit_edge = [&](Index h, std::vector<TJunction>& found) {
    const Vec3 a = positions[from_vertex(triangles, h)], d = positions[to_vertex(triangles, h)] - a;
    const double length = norm(d);
    if (length <= 2 * from_ends) return;
    tree.near_segment(a, a + d, reach, [&](Index v, const Vec3& p) {
      const Vec3 w = p - a;
      const double s = dot(w, d) / (length * length);
      if (s * length > from_ends && (1 - s) * length > from_ends && norm(w - s * d) < reach) found.push_back({h, v, s});
    });
  };

  const std::size_t tasks = (boundary.size() + k_edges_per_task - 1) / k_edges_per_task;
  std::vector<std::vector<TJunction>> found(tasks);
  oneapi::tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t task) {
    const std::size_t end = std::min(boundary.size(), (task + 1) * k_edges_per_task);
    for (std::size_t i = task * k_edges_per_task; i < end; ++i) visit_edge(boundary[i], found[task]);
  });

  std::vector<TJunction> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  std::sort(all.begin(), all.end(), [](const TJunction& a, const TJunction& b) {
    return std::tie(a.halfedge, a.s, a.vertex) < std::tie(b.halfedge, b.s, b.vertex);
  });
  return all;
}

}  // namespace papilla::detail
