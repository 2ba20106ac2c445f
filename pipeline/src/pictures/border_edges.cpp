// SPDX-License-Identifier: MIT
#include "pictures/border_edges.hpp"

#include <algorithm>
#include <span>

namespace papilla {

std::vector<std::array<bool, 3>> border_edges(std::span<const Triangle> triangles) {
  struct Edge {
    Index low, high;
    std::size_t triangle, corner;
  };
  std::vector<Edge> edges;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (triangles[t][0] == k_no_value) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangles[t][k], triangles[t][(k + 1) % 3]);
      edges.push_back({low, high, t, k});
    }
  }
  const auto ends = [](const Edge& e) { return std::pair{e.low, e.high}; };
  std::sort(edges.begin(), edges.end(), [&](const Edge& a, const Edge& b) { return ends(a) < ends(b); });
  std::vector<std::array<bool, 3>> borders(triangles.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool shared = (i > 0 && ends(edges[i - 1]) == ends(edges[i])) ||
                        (i + 1 < edges.size() && ends(edges[i + 1]) == ends(edges[i]));
    borders[edges[i].triangle][edges[i].corner] = !shared;
  }
  return borders;
}

}  // namespace papilla
