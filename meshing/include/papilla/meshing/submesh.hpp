// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "papilla/meshing/chart_set.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Some triangles of a mesh as a mesh of their own, with maps back.
struct Submesh {
  Values<Vec3> positions;
  Values<Triangle> triangles;
  std::vector<Index> vertex_of;    ///< Local vertex -> the mesh's vertex; several may name the same one.
  std::vector<Index> triangle_of;  ///< Local triangle -> the mesh's triangle, in the order asked for.
};

/// Takes out triangles so that every local vertex has one fan of triangles: a vertex where the piece touches itself
/// in a point, or across an edge that is not manifold within the piece, appears once per fan. Vertices are numbered in
/// the order of their first corner. O(k log k) for k triangles, whatever the size of the mesh. Deterministic.
/// @param triangles numbers of triangles of the mesh, each at most once.
/// @throws InvalidInput when a triangle or a vertex it names is out of range.
Submesh extract(const TriangleMesh& mesh, std::span<const Index> triangles);

/// The triangles of each chart, ascending. O(n).
/// @throws InvalidInput when a chart number is not below `charts.count`.
std::vector<std::vector<Index>> triangles_of_charts(const ChartSet& charts);

}  // namespace papilla
