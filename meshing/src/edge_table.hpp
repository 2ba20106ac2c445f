// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh_attributes.hpp"
#include "papilla/core/union_find.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::detail {

/// Half-edge h = 3 t + k runs from corner k of triangle t to its next corner.
constexpr Index triangle_of(Index halfedge) noexcept { return halfedge / 3; }
constexpr std::size_t corner_of(Index halfedge) noexcept { return halfedge % 3; }
constexpr Index next_halfedge(Index halfedge) noexcept { return halfedge % 3 == 2 ? halfedge - 2 : halfedge + 1; }
constexpr Index previous_halfedge(Index halfedge) noexcept { return halfedge % 3 == 0 ? halfedge + 2 : halfedge - 1; }

/// All edges of a triangle list with their half-edges, whatever their number: the half-edges grouped by edge,
/// edges in ascending order of (smaller vertex, larger vertex), half-edges ascending within an edge.
/// Triangles that repeat a corner are left out. O(n) plus sorting each vertex's edges; deterministic.
class EdgeTable {
 public:
  EdgeTable(std::span<const Triangle> triangles, std::size_t vertex_count);

  std::size_t size() const noexcept { return begin_.size() - 1; }
  std::span<const Index> halfedges(std::size_t edge) const noexcept {
    return std::span(halfedges_).subspan(begin_[edge], begin_[edge + 1] - begin_[edge]);
  }
  /// The half-edges of edges with one triangle, in the order of the edges.
  std::vector<Index> boundary_halfedges() const;

 private:
  std::vector<Index> halfedges_;
  std::vector<Index> begin_;
};

inline Index from_vertex(std::span<const Triangle> triangles, Index halfedge) noexcept {
  return triangles[triangle_of(halfedge)][corner_of(halfedge)];
}
inline Index to_vertex(std::span<const Triangle> triangles, Index halfedge) noexcept {
  return triangles[triangle_of(halfedge)][next_corner(corner_of(halfedge))];
}
/// The corner of its triangle that the half-edge does not touch.
inline Index apex_of(std::span<const Triangle> triangles, Index halfedge) noexcept {
  return from_vertex(triangles, previous_halfedge(halfedge));
}
/// True when the half-edge runs from its edge's smaller to its larger vertex.
inline bool runs_up(std::span<const Triangle> triangles, Index halfedge) noexcept {
  return from_vertex(triangles, halfedge) < to_vertex(triangles, halfedge);
}

/// The opposite half-edge of each half-edge whose edge has exactly two that run opposite ways, else k_none.
std::vector<Index> opposite_halfedges(std::span<const Triangle> triangles, const EdgeTable& edges);

/// The same within each label's triangles alone: edges of exactly two half-edges of one label that run opposite ways.
std::vector<Index> opposite_within_labels(std::span<const Triangle> triangles, const EdgeTable& edges,
                                          std::span<const std::uint32_t> labels);

/// Links the half-edges of one edge so. @param opposite is written where two are linked.
void link_within_labels(std::span<const Triangle> triangles, std::span<const Index> edge,
                        std::span<const std::uint32_t> labels, std::span<Index> opposite);

/// Joins the corners of one vertex that are linked through opposite half-edges: each set is one fan of triangles
/// around a vertex, and a manifold vertex has one. Corners are numbered like half-edges.
UnionFind join_fans(std::span<const Index> opposite);

/// Triangles around each vertex, as ranges of one array.
struct VertexTriangles {
  std::vector<Index> begin, triangles;
  VertexTriangles(std::span<const Triangle> mesh_triangles, std::size_t vertex_count);
  std::span<const Index> of(Index vertex) const noexcept {
    return std::span(triangles).subspan(begin[vertex], begin[vertex + 1] - begin[vertex]);
  }
};

}  // namespace papilla::detail
