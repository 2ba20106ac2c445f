// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "papilla/meshing/chart_set.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// The shape of one chart as a surface of its own, cut from its neighbours and open at its cuts, with one vertex per
/// fan of triangles (so two parts of a chart that touch in a point are not joined there).
struct ChartTopology {
  std::size_t triangles = 0;
  std::size_t components = 0;
  std::size_t boundary_loops = 0;
  std::int64_t euler = 0;  ///< χ = V - E + F.

  /// Handles of all components: (2 components - loops - χ) / 2; oriented surfaces only.
  std::int64_t genus() const noexcept {
    return (2 * static_cast<std::int64_t>(components) - static_cast<std::int64_t>(boundary_loops) - euler) / 2;
  }
  bool closed() const noexcept { return boundary_loops == 0; }
  /// Connected, χ = 1, one boundary loop: can be flattened without a cut.
  bool is_disk() const noexcept { return components == 1 && euler == 1 && boundary_loops == 1; }
};

/// The topology of every chart. Triangles are neighbours across edges of exactly two triangles of their chart that run
/// opposite ways and are not cut. O(n α(n)); deterministic.
/// @throws InvalidInput when the charts don't fit the mesh or an index is out of range.
std::vector<ChartTopology> chart_topologies(const TriangleMesh& mesh, const ChartSet& charts);

/// The topology of one chart. Costs as much as all of them.
/// @throws InvalidInput as chart_topologies(), and when `chart` is not below `charts.count`.
ChartTopology chart_topology(const TriangleMesh& mesh, const ChartSet& charts, std::uint32_t chart);

}  // namespace papilla
