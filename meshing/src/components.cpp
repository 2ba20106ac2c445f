// SPDX-License-Identifier: MIT
#include "components.hpp"

#include <algorithm>
#include <numeric>

#include "papilla/core/bounds.hpp"
#include "papilla/core/union_find.hpp"

namespace papilla::detail {

Components connected_triangles(const TriangleMesh& mesh) {
  UnionFind sets(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    sets.unite(t[0], t[1]);
    sets.unite(t[0], t[2]);
  }
  Index count = 0;
  const std::vector<Index> label = sets.labels(count);
  Components result;
  result.begin.assign(count + 1, 0);
  for (const Triangle& t : mesh.triangles) ++result.begin[label[t[0]] + 1];
  std::partial_sum(result.begin.begin(), result.begin.end(), result.begin.begin());
  std::vector<Index> next(result.begin.begin(), result.begin.end() - 1);
  result.triangles.resize(mesh.triangles.size());
  for (Index t = 0; t < mesh.triangles.size(); ++t) result.triangles[next[label[mesh.triangles[t][0]]]++] = t;
  return result;
}

Bounds3 bounds_of(const TriangleMesh& mesh, std::span<const Index> triangles) {
  Bounds3 bounds;
  for (const Index t : triangles)
    for (const Index v : mesh.triangles[t]) bounds.add(mesh.positions[v]);
  return bounds;
}

std::vector<std::vector<std::size_t>> parted_by_boxes(const std::vector<std::pair<std::size_t, Bounds3>>& boxes,
                                                      double margin) {
  constexpr std::size_t k_most_sets = 256;  // as each box is compared with that of each set
  struct Set {
    std::vector<std::size_t> members;
    Bounds3 bounds;
    void take(const Set& other) {
      members.insert(members.end(), other.members.begin(), other.members.end());
      bounds.add(other.bounds);
    }
  };
  std::vector<Set> sets;
  for (const auto& [number, bounds] : boxes) {
    Set grown{{number}, bounds};
    const auto is_near = [&](const Set& s) {
      return sets.size() > k_most_sets || s.bounds.overlaps(grown.bounds, margin);
    };
    for (auto near = std::find_if(sets.begin(), sets.end(), is_near); near != sets.end();
         near = std::find_if(sets.begin(), sets.end(), is_near)) {
      if (near->members.size() > grown.members.size()) std::swap(*near, grown);
      grown.take(*near);
      sets.erase(near);
    }
    sets.push_back(std::move(grown));
  }
  std::vector<std::vector<std::size_t>> members;
  for (Set& set : sets) members.push_back(std::move(set.members));
  return members;
}

}  // namespace papilla::detail
