// SPDX-License-Identifier: MIT
#include "papilla/meshing/cut_open.hpp"

#include <algorithm>
#include <string>

#include "check_mesh.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/union_find.hpp"

namespace papilla {
namespace {

using namespace detail;

/// Opposite half-edges of the whole mesh and within the opened charts.
struct Connectivity {
  std::vector<Index> whole, open;
};

Connectivity connect(const TriangleMesh& mesh, const EdgeTable& edges, const ChartSet& charts, const char* function) {
  return {opposite_halfedges(mesh.triangles, edges), opposite_within_charts(mesh, edges, charts, function)};
}

Connectivity connect(const TriangleMesh& mesh, const ChartSet& charts, const char* function) {
  check_charts(mesh, charts, function);
  return connect(mesh, EdgeTable(mesh.triangles, mesh.positions.size()), charts, function);
}

double seam_length(const TriangleMesh& mesh, const Connectivity& connectivity) {
  double length = 0;
  for (Index h = 0; h < connectivity.whole.size(); ++h) {
    const Index other = connectivity.whole[h];
    if (other == k_none || other < h || connectivity.open[h] != k_none) continue;
    length += norm(mesh.positions[to_vertex(mesh.triangles, h)] - mesh.positions[from_vertex(mesh.triangles, h)]);
  }
  return length;
}

}  // namespace

TriangleMesh cut_open(TriangleMesh mesh, const ChartSet& charts) {
  if (charts.cuts.empty()) return check_charts(mesh, charts, "cut_open"), mesh;
  const Connectivity connectivity = connect(mesh, charts, "cut_open");
  UnionFind fans = join_fans(connectivity.open);
  // The first fan of a chart at a vertex keeps its number; so do all fans of charts that no cut divides there.
  std::vector<std::uint8_t> divided(mesh.positions.size(), 0);
  for (const Index h : charts.cuts) divided[from_vertex(mesh.triangles, h)] = divided[to_vertex(mesh.triangles, h)] = 1;
  std::vector<Index> copy(3 * mesh.triangles.size(), k_none);
  std::vector<std::vector<std::uint32_t>> charts_at(mesh.positions.size());
  const std::size_t corners = copy.size();
  for (Index c = 0; c < corners; ++c) {
    const Index v = mesh.triangles[c / 3][c % 3];
    if (!divided[v] || fans.find(c) != c) continue;
    const std::uint32_t chart = charts.of_triangle[c / 3];
    auto& here = charts_at[v];
    if (std::find(here.begin(), here.end(), chart) == here.end()) {
      here.push_back(chart);
      continue;
    }
    copy[c] = static_cast<Index>(mesh.positions.size());
    mesh.positions.push_back(mesh.positions[v]);
  }
  for (Index c = 0; c < corners; ++c) {
    const Index number = copy[fans.find(c)];
    if (number != k_none) mesh.triangles[c / 3][c % 3] = number;
  }
  return mesh;
}

double seam_length(const TriangleMesh& mesh, const ChartSet& charts) {
  return seam_length(mesh, connect(mesh, charts, "seam_length"));
}

void keep_cuts(const TriangleMesh& mesh, std::span<const Index> halfedges, ChartSet& charts) {
  check_charts(mesh, charts, "keep_cuts");
  const EdgeTable edges(mesh.triangles, mesh.positions.size());
  const std::vector<Index> within = opposite_within_labels(mesh.triangles, edges, charts.of_triangle);
  charts.cuts.clear();
  for (const Index h : halfedges) {
    if (h >= within.size())
      throw InvalidInput("keep_cuts: half-edge " + std::to_string(h) + " of " + std::to_string(within.size()));
    if (within[h] != k_none) charts.cuts.push_back(h);
  }
  charts.seam_length_mm = seam_length(mesh, connect(mesh, edges, charts, "keep_cuts"));
}

}  // namespace papilla
