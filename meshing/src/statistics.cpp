// SPDX-License-Identifier: MIT
#include "papilla/meshing/statistics.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

#include "check_mesh.hpp"
#include "edge_table.hpp"
#include "exact_positions.hpp"
#include "find_t_junctions.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/core/union_find.hpp"
#include "same_triangles.hpp"
#include "triangle_shape.hpp"

namespace papilla {
namespace {

using namespace detail;

constexpr std::uint64_t pack(Index high, Index low) noexcept { return std::uint64_t{high} << 32 | low; }

/// The mesh with one vertex per distinct position.
struct Welded {
  std::vector<Vec3> positions;
  Values<Triangle> triangles;
};

Welded weld_exactly(const TriangleMesh& mesh) {
  const ExactPositions exact = exact_positions(mesh);
  Welded welded;
  welded.positions.reserve(exact.first.size());
  for (const Index v : exact.first) welded.positions.push_back(mesh.positions[v]);
  welded.triangles = mesh.triangles;
  for (Triangle& t : welded.triangles)
    for (Index& v : t) v = exact.of_position[v];
  return welded;
}

/// Returns the reference length.
double measure_box(const Welded& welded, MeshStatistics& result) {
  if (welded.positions.empty()) return 0;
  Bounds3 bounds;
  for (const Vec3& p : welded.positions) bounds.add(p);
  result.low = bounds.low;
  result.high = bounds.high;
  return reference_length(bounds);
}

/// Degenerate triangles, aspect, area; returns the signed volume seen from the box's centre.
double measure_shapes(const Welded& welded, double reference, MeshStatistics& result) {
  const Vec3 centre = 0.5 * (result.low + result.high);
  double volume = 0;
  for (const Triangle& t : welded.triangles) {
    const Vec3 a = welded.positions[t[0]], b = welded.positions[t[1]], c = welded.positions[t[2]];
    const TriangleShape shape = triangle_shape(a, b, c);
    if (repeats_corner(t) || shape.altitude < k_degenerate_altitude * reference)
      ++result.degenerate_triangles;
    else
      result.aspect_max = std::max(result.aspect_max, shape.longest_edge / shape.altitude);
    result.area_mm2 += 0.5 * shape.longest_edge * shape.altitude;
    volume += dot(a - centre, area_vector(a - centre, b - centre, c - centre)) / 6;
  }
  return volume;
}

void count_edges(std::span<const Triangle> triangles, const EdgeTable& edges, MeshStatistics& result) {
  result.edges = edges.size();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto h = edges.halfedges(e);
    result.boundary_edges += h.size() == 1;
    result.nonmanifold_edges += h.size() > 2;
    result.flipped_edges += h.size() == 2 && runs_up(triangles, h[0]) == runs_up(triangles, h[1]);
  }
}

/// Component per triangle; triangles that repeat a corner belong to none (k_none).
std::vector<Index> edge_components(std::span<const Triangle> triangles, const EdgeTable& edges, Index& count) {
  UnionFind sets(triangles.size());
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (const Index h : edges.halfedges(e).subspan(1))
      sets.unite(triangle_of(edges.halfedges(e).front()), triangle_of(h));
  std::vector<Index> component(triangles.size(), k_none);
  count = 0;
  for (Index t = 0; t < triangles.size(); ++t) {
    if (repeats_corner(triangles[t])) continue;
    const Index root = sets.find(t);
    component[t] = root == t ? count++ : component[root];
  }
  return component;
}

/// Number of sets that the pairs of keys connect, counted per value of `owner(key)`.
template <class Owner>
std::size_t count_connected(const std::vector<std::pair<std::uint64_t, std::uint64_t>>& links, const Owner& owner) {
  std::vector<std::uint64_t> keys;
  keys.reserve(2 * links.size());
  for (const auto& [a, b] : links) {
    keys.push_back(a);
    keys.push_back(b);
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  const auto number = [&](std::uint64_t key) {
    return static_cast<Index>(std::lower_bound(keys.begin(), keys.end(), key) - keys.begin());
  };
  UnionFind sets(keys.size());
  for (const auto& [a, b] : links) sets.unite(number(a), number(b));
  std::size_t count = 0;
  for (Index i = 0; i < keys.size(); ++i)
    if (sets.find(i) == i) {
      ++count;
      owner(keys[i]);
    }
  return count;
}

/// Vertices per component, a vertex shared by several components counting in each.
std::vector<std::int64_t> vertices_per_component(const Welded& welded, const std::vector<Index>& component,
                                                 Index count) {
  std::vector<Index> first(welded.positions.size(), k_none);
  std::vector<std::uint64_t> further;
  std::vector<std::int64_t> vertices(count, 0);
  for (std::size_t t = 0; t < component.size(); ++t) {
    if (component[t] == k_none) continue;
    for (const Index v : welded.triangles[t]) {
      if (first[v] == k_none) {
        first[v] = component[t];
        ++vertices[component[t]];
      } else if (first[v] != component[t]) {
        further.push_back(pack(component[t], v));
      }
    }
  }
  std::sort(further.begin(), further.end());
  further.erase(std::unique(further.begin(), further.end()), further.end());
  for (const std::uint64_t key : further) ++vertices[key >> 32];
  return vertices;
}

void count_topology(const Welded& welded, const EdgeTable& edges, MeshStatistics& result) {
  const auto& triangles = welded.triangles;
  Index count = 0;
  const std::vector<Index> component = edge_components(triangles, edges, count);
  result.components = count;

  std::vector<std::int64_t> euler = vertices_per_component(welded, component, count);  // V - E + F
  std::vector<std::uint8_t> manifold(count, 1);
  std::vector<std::pair<std::uint64_t, std::uint64_t>> in_mesh, in_component;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto h = edges.halfedges(e);
    const Index c = component[triangle_of(h.front())];
    --euler[c];
    if (h.size() > 2) manifold[c] = 0;
    if (h.size() > 1) continue;
    const Index a = from_vertex(triangles, h.front()), b = to_vertex(triangles, h.front());
    in_mesh.emplace_back(a, b);
    in_component.emplace_back(pack(c, a), pack(c, b));
  }
  for (const Index c : component)
    if (c != k_none) ++euler[c];

  result.boundary_loops = count_connected(in_mesh, [](std::uint64_t) {});
  std::vector<std::int64_t> loops(count, 0);
  count_connected(in_component, [&](std::uint64_t key) { ++loops[key >> 32]; });
  for (Index c = 0; c < count; ++c)
    if (manifold[c]) result.genus += 0.5 * static_cast<double>(2 - loops[c] - euler[c]);
}

std::size_t count_t_junctions(const Welded& welded, const EdgeTable& edges, double reference) {
  std::vector<Index> vertices;
  const double reach = k_touching_distance * reference, from_ends = 2 * reach + 2 * k_rounding_distance * reference;
  for (const TJunction& t : find_t_junctions(welded.positions, welded.triangles, edges, reach, from_ends))
    vertices.push_back(t.vertex);
  std::sort(vertices.begin(), vertices.end());
  return static_cast<std::size_t>(std::unique(vertices.begin(), vertices.end()) - vertices.begin());
}

}  // namespace

MeshStatistics mesh_statistics(const TriangleMesh& mesh) {
  check_mesh(mesh, "mesh_statistics");
  const Welded welded = weld_exactly(mesh);
  MeshStatistics result;
  result.triangles = mesh.triangles.size();
  result.vertices = welded.positions.size();
  result.has_uv = !mesh.uv.empty();
  const double reference = measure_box(welded, result);
  const double volume = measure_shapes(welded, reference, result);
  for_each_same_group(welded.triangles,
                      [&](std::span<const Index> same) { result.duplicate_triangles += same.size() - 1; });

  const EdgeTable edges(welded.triangles, welded.positions.size());
  count_edges(welded.triangles, edges, result);
  count_topology(welded, edges, result);
  result.t_junctions = count_t_junctions(welded, edges, reference);
  const bool closed = result.boundary_edges == 0 && result.nonmanifold_edges == 0 && result.flipped_edges == 0;
  if (closed && result.edges > 0) result.volume_mm3 = volume;
  return result;
}

}  // namespace papilla
