// SPDX-License-Identifier: MIT
#include "adjacency.hpp"

#include <algorithm>
#include <numeric>
#include <span>
#include <tuple>
#include <vector>

#include "chunks.hpp"

namespace papilla::param_detail {
namespace {

/// Vertices with more corners than this are matched by sorting instead of scanning.
constexpr Index k_hub_valence = 64;

/// A corner as its vertex sees it: the vertices after and before it in its triangle.
struct StarCorner {
  Index after, before, corner;
};

/// The corners around each vertex: corners[first[v]] to corners[first[v + 1]].
struct Stars {
  std::vector<Index> first;
  std::vector<StarCorner> corners;
  Index valence(Index v) const { return first[v + 1] - first[v]; }
  std::span<const StarCorner> of(Index v) const { return std::span(corners).subspan(first[v], valence(v)); }
};

Stars stars_of(const TriangleMesh& mesh) {
  Stars stars;
  stars.first.assign(mesh.positions.size() + 2, 0);
  for (const Triangle& t : mesh.triangles)
    for (const Index v : t) ++stars.first[v + 2];
  std::partial_sum(stars.first.begin(), stars.first.end(), stars.first.begin());
  stars.corners.resize(3 * mesh.triangles.size());
  for (Index i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b, c] = mesh.triangles[i];
    stars.corners[stars.first[a + 1]++] = {b, c, 3 * i};
    stars.corners[stars.first[b + 1]++] = {c, a, 3 * i + 1};
    stars.corners[stars.first[c + 1]++] = {a, b, 3 * i + 2};
  }
  stars.first.pop_back();
  return stars;
}

/// Links the two triangles of an edge, given a halfedge of it and all that its vertex sees.
void link_edge(std::span<const StarCorner> star, const StarCorner& edge, Adjacency& across) {
  Index forward = 0, backward = 0, back = 0;
  for (const StarCorner& c : star) {
    forward += c.after == edge.after;
    if (c.before == edge.after) ++backward, back = previous(c.corner);
  }
  if (forward != 1 || backward != 1 || back / 3 == edge.corner / 3) return;
  across[edge.corner] = back / 3;
  across[back] = edge.corner / 3;
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
  Adjacency across(3 * mesh.triangles.size(), k_no_triangle);
  const Stars stars = stars_of(mesh);
  const auto is_hub = [&](Index v) { return stars.valence(v) > k_hub_valence; };
  // Each edge is linked from the smaller one of its vertices that are no hubs.
  for_chunks(mesh.positions.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (auto a = static_cast<Index>(begin); a < end; ++a) {
      if (is_hub(a)) continue;
      for (const StarCorner& edge : stars.of(a))
        if (a < edge.after || (a != edge.after && is_hub(edge.after))) link_edge(stars.of(a), edge, across);
    }
  });
  std::vector<HubEdge> hub_edges;
  for (Index a = 0; a < mesh.positions.size(); ++a) {
    if (!is_hub(a)) continue;
    for (const auto& [b, before, corner] : stars.of(a))
      if (is_hub(b)) hub_edges.push_back({std::min(a, b), std::max(a, b), corner, a < b});
  }
  link_hub_edges(hub_edges, across);
  return across;
}

}  // namespace papilla::param_detail
