// SPDX-License-Identifier: MIT
#include "papilla/meshing/t_junction.hpp"

#include <algorithm>
#include <span>
#include <string>

#include "check_mesh.hpp"
#include "find_t_junctions.hpp"
#include "papilla/core/error.hpp"
#include "papilla/meshing/mesh_bounds.hpp"
#include "repair_steps.hpp"

namespace papilla {
namespace {

using namespace detail;

/// Splits half-edge k of a triangle at its T-junctions (ascending s), each time going on with the rest;
/// returns the triangle that has the end of the half-edge.
Index split_halfedge(TriangleMesh& mesh, Index triangle, std::size_t k, std::span<const TJunction> junctions) {
  double start = 0;
  for (const TJunction& j : junctions) {
    triangle = split_triangle(mesh, triangle, k, j.vertex, (j.s - start) / (1 - start));
    start = j.s;
  }
  return triangle;
}

bool names(const Triangle& t, Index v) noexcept { return t[0] == v || t[1] == v || t[2] == v; }

double distance_to_edge(const TriangleMesh& mesh, const TJunction& j) {
  const Vec3 a = mesh.positions[from_vertex(mesh.triangles, j.halfedge)];
  const Vec3 b = mesh.positions[to_vertex(mesh.triangles, j.halfedge)];
  return norm(mesh.positions[j.vertex] - a - j.s * (b - a));
}

/// Splits the boundary half-edges of one triangle. Splitting half-edge k leaves the half-edge before it to the triangle
/// itself and gives the one after it to the last new triangle; corners keep their numbers.
void split_sides(TriangleMesh& mesh, std::span<const TJunction> junctions, TJunctionResult& result) {
  const Index triangle = triangle_of(junctions.front().halfedge);
  Index holder[3] = {triangle, triangle, triangle};
  for (std::size_t begin = 0, end = 0; begin < junctions.size(); begin = end) {
    const Index halfedge = junctions[begin].halfedge;
    while (end < junctions.size() && junctions[end].halfedge == halfedge) ++end;
    const std::size_t k = corner_of(halfedge);
    const Index now = holder[k];
    const Index last = split_halfedge(mesh, now, k, junctions.subspan(begin, end - begin));
    if (holder[next_corner(k)] == now) holder[next_corner(k)] = last;
    ++result.split_edges;
  }
  result.inserted_vertices += junctions.size();
}

}  // namespace

namespace detail {

bool split_borders(TriangleMesh& mesh, const EdgeTable& edges, double reach_mm, double from_ends_mm,
                   TJunctionResult& result) {
  const std::vector<TJunction> junctions =
      find_t_junctions(mesh.positions, mesh.triangles, edges, reach_mm, from_ends_mm);
  if (junctions.empty()) return false;
  for (const TJunction& j : junctions)
    result.max_deviation_mm = std::max(result.max_deviation_mm, distance_to_edge(mesh, j));

  std::vector<std::uint8_t> keep(mesh.triangles.size(), 1);
  for (std::size_t begin = 0, end = 0; begin < junctions.size(); begin = end) {
    const Index triangle = triangle_of(junctions[begin].halfedge);
    bool apex_on_edge = false;
    for (; end < junctions.size() && triangle_of(junctions[end].halfedge) == triangle; ++end)
      apex_on_edge = apex_on_edge || names(mesh.triangles[triangle], junctions[end].vertex);
    if (apex_on_edge) {
      keep[triangle] = 0;
      ++result.slivers;
    } else {
      split_sides(mesh, std::span(junctions).subspan(begin, end - begin), result);
    }
  }
  keep.resize(mesh.triangles.size(), 1);
  keep_triangles(mesh, keep);
  result.repeated += drop_repeated_corners(mesh);
  drop_unused(mesh);
  return true;
}

}  // namespace detail

TJunctionResult split_t_junctions(TriangleMesh mesh, const TJunctionOptions& options) {
  if (!(options.relative_tolerance >= 0 && options.relative_tolerance <= 0.1))
    throw InvalidInput("split_t_junctions: relative_tolerance " + std::to_string(options.relative_tolerance) +
                       " is not in [0, 0.1]");
  check_mesh(mesh, "split_t_junctions");
  TJunctionResult result;
  const double tolerance = options.relative_tolerance * bounds_of(mesh).diagonal();
  split_borders(mesh, EdgeTable(mesh.triangles, mesh.positions.size()), tolerance, 2 * tolerance, result);
  result.mesh = std::move(mesh);
  return result;
}

}  // namespace papilla
