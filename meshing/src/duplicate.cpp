// SPDX-License-Identifier: MIT
#include "papilla/meshing/duplicate.hpp"

#include <algorithm>

#include "check_mesh.hpp"
#include "papilla/core/union_find.hpp"
#include "repair_steps.hpp"
#include "same_triangles.hpp"

namespace papilla {
namespace {

using namespace detail;

/// True when the corners ascend in the triangle's sense, starting at the smallest.
bool ascends(const Triangle& t) noexcept {
  const std::size_t k = t[0] < t[1] && t[0] < t[2] ? 0 : t[1] < t[2] ? 1 : 2;
  return t[next_corner(k)] < t[previous_corner(k)];
}

enum State : std::uint8_t { k_drop, k_keep, k_keep_of_pair };

/// Keeps the first of every set; `k_keep_of_pair` when its opposites were dropped.
std::vector<std::uint8_t> keep_first(const std::vector<Triangle>& triangles, DuplicateResult& result) {
  std::vector<std::uint8_t> state(triangles.size(), k_keep);
  for_each_same_group(triangles, [&](std::span<const Index> group) {
    for (const Index t : group.subspan(1)) {
      state[t] = k_drop;
      const bool same = ascends(triangles[t]) == ascends(triangles[group.front()]);
      ++(same ? result.same : result.opposite);
      if (!same) state[group.front()] = k_keep_of_pair;
    }
  });
  return state;
}

/// Drops the kept halves of sheets that only part touching solids.
void drop_walls(const TriangleMesh& mesh, const EdgeTable& edges, std::vector<std::uint8_t>& state,
                DuplicateResult& result) {
  UnionFind sheets(mesh.triangles.size());
  std::vector<std::pair<Index, bool>> borders;  // sheet triangle, does the border carry other surface on both sides
  for (std::size_t e = 0; e < edges.size(); ++e) {
    Index halves = 0, others = 0, first = k_none;
    for (const Index h : edges.halfedges(e)) {
      const Index t = triangle_of(h);
      others += state[t] == k_keep;
      if (state[t] != k_keep_of_pair) continue;
      if (halves++ == 0) first = t;
      sheets.unite(first, t);
    }
    if (halves == 1) borders.emplace_back(first, others >= 2);
  }
  std::vector<std::uint8_t> has_border(mesh.triangles.size(), 0), is_free(mesh.triangles.size(), 0);
  for (const auto& [t, carried] : borders) (carried ? has_border : is_free)[sheets.find(t)] = 1;
  for (Index t = 0; t < state.size(); ++t) {
    const Index sheet = sheets.find(t);
    if (state[t] != k_keep_of_pair || !has_border[sheet] || is_free[sheet]) continue;
    state[t] = k_drop;
    ++result.walls;
  }
}

Index apex(const std::vector<Triangle>& triangles, Index halfedge) noexcept {
  return from_vertex(triangles, previous_halfedge(halfedge));
}

bool share_apex(std::span<const Index> halfedges, const std::vector<Triangle>& triangles) {
  if (halfedges.size() == 2) return apex(triangles, halfedges[0]) == apex(triangles, halfedges[1]);
  std::vector<Index> apexes;
  for (const Index h : halfedges) apexes.push_back(apex(triangles, h));
  std::sort(apexes.begin(), apexes.end());
  return std::adjacent_find(apexes.begin(), apexes.end()) != apexes.end();
}

}  // namespace

namespace detail {

bool has_duplicates(const std::vector<Triangle>& triangles, const EdgeTable& edges) {
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (edges.halfedges(e).size() > 1 && share_apex(edges.halfedges(e), triangles)) return true;
  return false;
}

bool drop_duplicates(TriangleMesh& mesh, const EdgeTable& edges, DuplicateResult& result) {
  if (!has_duplicates(mesh.triangles, edges)) return false;
  std::vector<std::uint8_t> state = keep_first(mesh.triangles, result);
  if (result.opposite > 0) drop_walls(mesh, edges, state, result);
  keep_triangles(mesh, state);
  return true;
}

}  // namespace detail

DuplicateResult remove_duplicates(TriangleMesh mesh) {
  check_mesh(mesh, "remove_duplicates");
  DuplicateResult result;
  drop_duplicates(mesh, EdgeTable(mesh.triangles, mesh.positions.size()), result);
  result.mesh = std::move(mesh);
  return result;
}

}  // namespace papilla
