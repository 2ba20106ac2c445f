// SPDX-License-Identifier: MIT
#include "papilla/meshing/submesh.hpp"

#include <algorithm>
#include <string>

#include "edge_table.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/union_find.hpp"

namespace papilla {
namespace {

using namespace detail;

/// The triangles with the mesh's vertices numbered densely; returns how many there are.
std::size_t number_densely(std::span<Triangle> triangles) {
  std::vector<Index> vertices;
  vertices.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) vertices.insert(vertices.end(), t.begin(), t.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  for (Triangle& t : triangles)
    for (Index& v : t) v = static_cast<Index>(std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin());
  return vertices.size();
}

}  // namespace

Submesh extract(const TriangleMesh& mesh, std::span<const Index> triangles) {
  Submesh result;
  result.triangle_of.assign(triangles.begin(), triangles.end());
  std::vector<Triangle> dense;
  dense.reserve(triangles.size());
  for (const Index t : triangles) {
    if (t >= mesh.triangles.size()) throw InvalidInput("extract: triangle " + std::to_string(t) + " is out of range");
    for (const Index v : mesh.triangles[t])
      if (v >= mesh.positions.size())
        throw InvalidInput("extract: triangle " + std::to_string(t) + " names vertex " + std::to_string(v) +
                           ", which is out of range");
    dense.push_back(mesh.triangles[t]);
  }
  const std::size_t vertex_count = number_densely(dense);
  const std::vector<Index> opposite = opposite_halfedges(dense, EdgeTable(dense, vertex_count));
  UnionFind fans = join_fans(opposite);
  Index count = 0;
  const std::vector<Index> vertex_of_corner = fans.labels(count);
  result.positions.resize(count);
  result.vertex_of.resize(count);
  result.triangles.resize(triangles.size());
  for (Index i = 0; i < triangles.size(); ++i)
    for (Index k = 0; k < 3; ++k) {
      const Index local = vertex_of_corner[3 * i + k], global = mesh.triangles[triangles[i]][k];
      result.triangles[i][k] = local;
      result.vertex_of[local] = global;
      result.positions[local] = mesh.positions[global];
    }
  return result;
}

std::vector<std::vector<Index>> triangles_of_charts(const ChartSet& charts) {
  std::vector<std::vector<Index>> triangles(charts.count);
  for (std::size_t t = 0; t < charts.of_triangle.size(); ++t) {
    if (charts.of_triangle[t] >= charts.count)
      throw InvalidInput("triangles_of_charts: chart " + std::to_string(charts.of_triangle[t]) + " of triangle " +
                         std::to_string(t) + " is out of range");
    triangles[charts.of_triangle[t]].push_back(static_cast<Index>(t));
  }
  return triangles;
}

}  // namespace papilla
