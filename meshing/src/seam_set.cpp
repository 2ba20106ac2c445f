// SPDX-License-Identifier: MIT
#include "seam_set.hpp"

#include <algorithm>

#include "papilla/core/union_find.hpp"

namespace papilla::detail {

std::vector<std::uint8_t> seams_of(const SegmentedMesh& surface, const std::vector<std::uint32_t>& labels,
                                   const std::vector<std::uint32_t>& cuts) {
  std::vector<std::uint8_t> seam(surface.opposite.size());
  for (Index h = 0; h < seam.size(); ++h) {
    const Index other = surface.opposite[h];
    seam[h] = other == k_none || labels[triangle_of(h)] != labels[triangle_of(other)];
  }
  for (const Index h : cuts) {
    seam[h] = 1;
    if (surface.opposite[h] != k_none) seam[surface.opposite[h]] = 1;
  }
  return seam;
}

ChartSet charts_between(const SegmentedMesh& surface, const std::vector<std::uint8_t>& seam) {
  UnionFind sets(surface.size());
  for (Index h = 0; h < seam.size(); ++h)
    if (!seam[h]) sets.unite(triangle_of(h), triangle_of(surface.opposite[h]));
  ChartSet charts;
  charts.of_triangle = sets.labels(charts.count);
  for (Index h = 0; h < seam.size(); ++h) {
    const Index other = surface.opposite[h];
    if (!seam[h] || other == k_none || other < h) continue;
    charts.seam_length_mm += surface.length(h);
    if (charts.of_triangle[triangle_of(h)] == charts.of_triangle[triangle_of(other)]) charts.cuts.push_back(h);
  }
  // Edges of more triangles are no neighbours, whatever number of them one chart has.
  const std::vector<Index> within = opposite_within_labels(surface.triangles, surface.edges, charts.of_triangle);
  for (Index h = 0; h < seam.size(); ++h)
    if (surface.opposite[h] == k_none && within[h] != k_none && h < within[h]) charts.cuts.push_back(h);
  std::sort(charts.cuts.begin(), charts.cuts.end());
  return charts;
}

}  // namespace papilla::detail
