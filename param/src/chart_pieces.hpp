// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "adjacency.hpp"
#include "papilla/meshing/chart_set.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::param_detail {

/// The triangles of each chart, in mesh order within a chart.
struct TrianglesOfCharts {
  std::vector<Index> first, triangles;
  std::span<const Index> of(std::uint32_t chart) const {
    return {triangles.data() + first[chart], first[chart + 1] - first[chart]};
  }
};

TrianglesOfCharts sort_by_chart(const std::vector<std::uint32_t>& chart_of_triangle, std::uint32_t count);

/// Length of the edges between linked triangles of different charts, each edge once.
double seam_length(const TriangleMesh& mesh, const Adjacency& across, const std::vector<std::uint32_t>& chart);

/// One chart as a surface of its own: corners that meet over chart-interior edges are one vertex, so that
/// a vertex where the chart touches itself counts once per touching fan.
struct ChartSurface {
  Values<Vec3> positions;
  Values<Triangle> triangles;    ///< In the order of the chart's triangle list.
  std::vector<Triangle> across;  ///< Neighbour numbers within the chart, or k_no_triangle.
  /// The uv that each triangle has in another map, which may be cut in another way; empty: none is known.
  std::vector<std::array<Vec2, 3>> nearby;
};

/// Cuts charts out of one mesh; holds scratch memory of one entry per mesh triangle.
class ChartCutter {
 public:
  ChartCutter(const TriangleMesh& mesh, const Adjacency& across, const ChartSet& charts)
      : mesh_(&mesh), across_(&across), charts_(&charts), local_(mesh.triangles.size(), k_no_triangle) {
    // Charts are disjoint, so that all local numbers fit into one array.
    std::vector<Index> next(charts.count, 0);
    for (std::size_t t = 0; t < local_.size(); ++t) local_[t] = next[charts.of_triangle[t]]++;
  }
  ChartSurface cut(std::uint32_t chart, std::span<const Index> triangles) const;

 private:
  const TriangleMesh* mesh_;
  const Adjacency* across_;
  const ChartSet* charts_;
  std::vector<Index> local_;
};

}  // namespace papilla::param_detail
