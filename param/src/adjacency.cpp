// SPDX-License-Identifier: MIT
#include "adjacency.hpp"

#include <algorithm>
#include <tuple>

namespace papilla::param_detail {
namespace {

/// Vertices with more corners than this are matched by sorting instead of scanning.
constexpr Index k_hub_valence = 64;

constexpr Index next(Index corner) noexcept { return corner % 3 == 2 ? corner - 2 : corner + 1; }
constexpr Index previous(Index corner) noexcept { return corner % 3 == 0 ? corner + 2 : corner - 1; }

/// The corners around each vertex: corners[first[v]] to corners[first[v + 1]].
struct VertexCorners {
  std::vector<Index> first, corners;
  Index valence(Index v) const { return first[v + 1] - first[v]; }
};

VertexCorners corners_of_vertices(const Index* vertex, std::size_t corner_count, std::size_t vertex_count) {
  VertexCorners result;
  result.first.assign(vertex_count + 2, 0);
  for (std::size_t c = 0; c < corner_count; ++c) ++result.first[vertex[c] + 2];
  for (std::size_t v = 2; v < result.first.size(); ++v) result.first[v] += result.first[v - 1];
  result.corners.resize(corner_count);
  for (std::size_t c = 0; c < corner_count; ++c) result.corners[result.first[vertex[c] + 1]++] = static_cast<Index>(c);
  result.first.pop_back();
  return result;
}

/// The halfedges of the edge from a to b that are seen from the corners at `at` (a or b).
struct EdgeUses {
  Index forward = 0, backward = 0;            ///< How many run a -> b and b -> a.
  Index forward_edge = 0, backward_edge = 0;  ///< The last of them.
};

EdgeUses edge_uses(const Index* vertex, const VertexCorners& around, Index at, Index other, bool at_is_start) {
  Index leaving = 0, arriving = 0, leaving_edge = 0, arriving_edge = 0;
  for (Index i = around.first[at]; i < around.first[at + 1]; ++i) {
    const Index c = around.corners[i];
    if (vertex[next(c)] == other) ++leaving, leaving_edge = c;
    const Index before = previous(c);
    if (vertex[before] == other) ++arriving, arriving_edge = before;
  }
  if (at_is_start) return {leaving, arriving, leaving_edge, arriving_edge};
  return {arriving, leaving, arriving_edge, leaving_edge};
}

/// A halfedge between two hubs; sorting brings the uses of one edge together.
struct HubEdge {
  Index low, high, halfedge;
  bool forward;
  bool operator<(const HubEdge& other) const {
    return std::tie(low, high, halfedge) < std::tie(other.low, other.high, other.halfedge);
  }
};

void link_hub_edges(std::vector<HubEdge>& edges, Adjacency& across) {
  std::sort(edges.begin(), edges.end());
  for (std::size_t begin = 0; begin < edges.size();) {
    std::size_t end = begin + 1;
    while (end < edges.size() && edges[end].low == edges[begin].low && edges[end].high == edges[begin].high) ++end;
    if (end == begin + 2 && edges[begin].forward != edges[begin + 1].forward) {
      across[edges[begin].halfedge] = edges[begin + 1].halfedge / 3;
      across[edges[begin + 1].halfedge] = edges[begin].halfedge / 3;
    }
    begin = end;
  }
}

}  // namespace

Adjacency connect_triangles(const TriangleMesh& mesh) {
  const std::size_t corner_count = 3 * mesh.triangles.size();
  Adjacency across(corner_count, k_no_triangle);
  if (corner_count == 0) return across;
  const Index* vertex = mesh.triangles.front().data();
  const VertexCorners around = corners_of_vertices(vertex, corner_count, mesh.positions.size());
  std::vector<HubEdge> hub_edges;
  for (Index h = 0; h < corner_count; ++h) {
    if (across[h] != k_no_triangle) continue;
    const Index a = vertex[h], b = vertex[next(h)];
    if (a == b) continue;
    const bool at_start = around.valence(a) <= around.valence(b);
    if (around.valence(at_start ? a : b) > k_hub_valence) {
      hub_edges.push_back({std::min(a, b), std::max(a, b), h, a < b});
      continue;
    }
    const EdgeUses uses = edge_uses(vertex, around, at_start ? a : b, at_start ? b : a, at_start);
    if (uses.forward != 1 || uses.backward != 1 || uses.forward_edge / 3 == uses.backward_edge / 3) continue;
    across[uses.forward_edge] = uses.backward_edge / 3;
    across[uses.backward_edge] = uses.forward_edge / 3;
  }
  link_hub_edges(hub_edges, across);
  return across;
}

}  // namespace papilla::param_detail
