// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::param_detail {

/// The same difference of texture coordinates up to whole repeats, nearest to zero. A tile size of 0 wraps nothing.
inline Vec2 wrap_to_tile(Vec2 difference, Vec2 tile) {
  const auto wrap = [](double x, double period) { return period > 0 ? x - period * std::round(x / period) : x; };
  return {wrap(difference.x, tile.x), wrap(difference.y, tile.y)};
}

/// An edge as its two triangles see it in the plane: uv at its start and end (of the first triangle's direction).
struct SeamEdge {
  double length_mm = 0;
  Vec2 here[2], there[2];
};

/// @param k the edge from corner k of triangle t, across which `other` lies.
inline SeamEdge seam_edge(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv, std::size_t t, std::size_t k,
                          std::size_t other) {
  SeamEdge edge;
  const Index start = mesh.triangles[t][k], end = mesh.triangles[t][(k + 1) % 3];
  edge.length_mm = norm(mesh.positions[end] - mesh.positions[start]);
  edge.here[0] = uv.values[uv.indices[t][k]];
  edge.here[1] = uv.values[uv.indices[t][(k + 1) % 3]];
  for (std::size_t m = 0; m < 3; ++m) {
    if (mesh.triangles[other][m] != end || mesh.triangles[other][(m + 1) % 3] != start) continue;
    edge.there[1] = uv.values[uv.indices[other][m]];
    edge.there[0] = uv.values[uv.indices[other][(m + 1) % 3]];
  }
  return edge;
}

}  // namespace papilla::param_detail
