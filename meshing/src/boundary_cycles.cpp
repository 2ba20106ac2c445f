// SPDX-License-Identifier: MIT
#include "papilla/meshing/boundary_cycles.hpp"

#include "check_mesh.hpp"
#include "edge_table.hpp"
#include "papilla/core/union_find.hpp"

namespace papilla {

std::size_t boundary_cycles(const TriangleMesh& mesh) {
  using namespace detail;
  check_mesh(mesh, "boundary_cycles");
  const EdgeTable edges(mesh.triangles, mesh.positions.size());
  UnionFind sets(mesh.positions.size());
  std::size_t odd = 0, joined = 0;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto halfedges = edges.halfedges(e);
    if (halfedges.size() % 2 == 0) continue;
    ++odd;
    const Index a = from_vertex(mesh.triangles, halfedges[0]), b = to_vertex(mesh.triangles, halfedges[0]);
    if (sets.find(a) == sets.find(b)) continue;
    sets.unite(a, b);
    ++joined;
  }
  return odd - joined;  // C = V - joined
}

}  // namespace papilla
