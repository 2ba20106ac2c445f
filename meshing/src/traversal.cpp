// SPDX-License-Identifier: MIT
#include "traversal.hpp"

#include <span>

namespace papilla::detail {

std::vector<Index> neighbours(const EdgeTable& edges, std::size_t triangle_count) {
  std::vector<Index> neighbour(3 * triangle_count, k_none);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto h = edges.halfedges(e);
    if (h.size() != 2) continue;
    neighbour[h[0]] = h[1];
    neighbour[h[1]] = h[0];
  }
  return neighbour;
}

Traversal traverse(std::span<const Triangle> triangles, std::span<const Index> neighbour,
                   std::vector<std::uint8_t> seen, std::size_t& conflicts) {
  Traversal result;
  result.order.reserve(triangles.size());
  result.turn.assign(triangles.size(), 0);
  std::size_t conflict_halfedges = 0;
  for (Index seed = 0; seed < triangles.size(); ++seed) {
    if (seen[seed]) continue;
    Component component;
    component.begin = result.order.size();
    seen[seed] = 1;
    result.order.push_back(seed);
    for (std::size_t at = component.begin; at < result.order.size(); ++at) {
      const Index t = result.order[at];
      component.turned += result.turn[t];
      for (Index h = 3 * t; h < 3 * t + 3; ++h) {
        if (neighbour[h] == k_none) {
          component.closed = false;
          continue;
        }
        const Index other = triangle_of(neighbour[h]);
        const bool same_way = runs_up(triangles, h) == runs_up(triangles, neighbour[h]);
        const std::uint8_t wanted = result.turn[t] ^ static_cast<std::uint8_t>(same_way);
        if (!seen[other]) {
          seen[other] = 1;
          result.turn[other] = wanted;
          result.order.push_back(other);
        } else if (result.turn[other] != wanted) {
          component.orientable = false;
          ++conflict_halfedges;
        }
      }
    }
    component.end = result.order.size();
    result.components.push_back(component);
  }
  conflicts = conflict_halfedges / 2;
  return result;
}

}  // namespace papilla::detail
