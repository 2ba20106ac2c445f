// SPDX-License-Identifier: MIT
#include "check_charts.hpp"

#include <string>

#include "check_mesh.hpp"
#include "papilla/core/error.hpp"

namespace papilla::detail {

void check_charts(const TriangleMesh& mesh, const ChartSet& charts, const char* function) {
  check_mesh(mesh, function);
  const std::string name(function);
  if (charts.of_triangle.size() != mesh.triangles.size())
    throw InvalidInput(name + ": " + std::to_string(charts.of_triangle.size()) + " chart numbers for " +
                       std::to_string(mesh.triangles.size()) + " triangles");
  for (std::size_t t = 0; t < charts.of_triangle.size(); ++t)
    if (charts.of_triangle[t] >= charts.count)
      throw InvalidInput(name + ": chart " + std::to_string(charts.of_triangle[t]) + " of triangle " +
                         std::to_string(t) + " is out of range");
}

std::vector<Index> opposite_within_charts(const TriangleMesh& mesh, const EdgeTable& edges, const ChartSet& charts,
                                          const char* function) {
  std::vector<Index> opposite = opposite_within_labels(mesh.triangles, edges, charts.of_triangle);
  for (const Index h : charts.cuts) {
    if (h >= opposite.size() || opposite[h] == k_none)
      throw InvalidInput(std::string(function) + ": cut " + std::to_string(h) + " is no edge within a chart");
    opposite[opposite[h]] = k_none;
    opposite[h] = k_none;
  }
  return opposite;
}

}  // namespace papilla::detail
