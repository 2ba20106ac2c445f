// SPDX-License-Identifier: MIT
#include "papilla/meshing/chart_topology.hpp"

#include <span>
#include <string>

#include "check_mesh.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/union_find.hpp"

namespace papilla {
namespace {

using namespace detail;

/// The topology of every label's triangles, given their opposite half-edges within the labels.
std::vector<ChartTopology> label_topologies(std::span<const Index> opposite, std::span<const std::uint32_t> labels,
                                            std::uint32_t count) {
  UnionFind fans = join_fans(opposite), loops(opposite.size()), sheets(labels.size());
  std::vector<std::int64_t> twice_edges(count, 0);
  std::vector<std::uint8_t> on_boundary(opposite.size(), 0);
  for (Index h = 0; h < opposite.size(); ++h) {
    if (opposite[h] != k_none) {
      ++twice_edges[labels[triangle_of(h)]];
      sheets.unite(triangle_of(h), triangle_of(opposite[h]));
      continue;
    }
    twice_edges[labels[triangle_of(h)]] += 2;
    const Index from = fans.find(h), to = fans.find(next_halfedge(h));
    on_boundary[from] = on_boundary[to] = 1;
    loops.unite(from, to);
  }

  std::vector<ChartTopology> result(count);
  for (Index h = 0; h < opposite.size(); ++h) {
    ChartTopology& chart = result[labels[triangle_of(h)]];
    chart.euler += fans.find(h) == h;
    chart.boundary_loops += on_boundary[h] && loops.find(h) == h;
  }
  for (Index t = 0; t < labels.size(); ++t) {
    ++result[labels[t]].triangles;
    result[labels[t]].components += sheets.find(t) == t;
  }
  for (std::uint32_t c = 0; c < count; ++c)
    result[c].euler += static_cast<std::int64_t>(result[c].triangles) - twice_edges[c] / 2;
  return result;
}

}  // namespace

std::vector<ChartTopology> chart_topologies(const TriangleMesh& mesh, const ChartSet& charts) {
  check_charts(mesh, charts, "chart_topologies");
  const EdgeTable edges(mesh.triangles, mesh.positions.size());
  const std::vector<Index> opposite = opposite_within_charts(mesh, edges, charts, "chart_topologies");
  return label_topologies(opposite, charts.of_triangle, charts.count);
}

ChartTopology chart_topology(const TriangleMesh& mesh, const ChartSet& charts, std::uint32_t chart) {
  if (chart >= charts.count)
    throw InvalidInput("chart_topology: chart " + std::to_string(chart) + " of " + std::to_string(charts.count));
  return chart_topologies(mesh, charts)[chart];
}

}  // namespace papilla
