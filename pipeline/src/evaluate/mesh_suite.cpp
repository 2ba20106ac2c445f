// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "evaluate/extreme_meshes.hpp"
#include "evaluate/suite.hpp"
#include "papilla/meshing/chart_topology.hpp"
#include "papilla/meshing/mesh_bounds.hpp"
#include "papilla/meshing/repair.hpp"
#include "papilla/meshing/segmentation.hpp"
#include "papilla/meshing/simplify.hpp"
#include "papilla/meshing/statistics.hpp"
#include "papilla/meshing/weld.hpp"

namespace papilla {
namespace {

constexpr double k_tolerance = 1e-3;  // Of the diagonal, for simplification.

/// A triangle soup, as in STL: no two triangles share a vertex.
TriangleMesh soup_from(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const Triangle& triangle : mesh.triangles) {
    const auto first = static_cast<Index>(soup.positions.size());
    for (const Index v : triangle) soup.positions.push_back(mesh.positions[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

double defect_count(const TriangleMesh& mesh) {
  const MeshStatistics s = mesh_statistics(mesh);
  return static_cast<double>(s.nonmanifold_edges + s.degenerate_triangles + s.duplicate_triangles + s.flipped_edges +
                             s.t_junctions);
}

void weld_soup(const TriangleMesh& mesh, StabilityCell& cell) {
  const double diagonal = bounds_of(mesh).diagonal();
  const std::size_t before = mesh.triangles.size();
  const WeldResult result = weld(soup_from(mesh));
  cell.error = result.max_deviation_mm / diagonal;
  cell.note = fmt::format("{} vertices, {} of {} triangles", result.mesh.positions.size(), result.mesh.triangles.size(),
                          before);
  if (result.max_deviation_mm > result.tolerance_mm) cell.outcome = Outcome::breaks;
}

void repair_soup(const TriangleMesh& mesh, StabilityCell& cell) {
  const double diagonal = bounds_of(mesh).diagonal();
  const RepairResult result = repair(soup_from(mesh));
  cell.error = result.max_deviation_mm / diagonal;
  cell.residual = defect_count(result.mesh);
  cell.iterations = static_cast<int>(result.passes);
  cell.note = fmt::format("{} of {} triangles", result.mesh.triangles.size(), mesh.triangles.size());
  if (*cell.residual > 0 || !result.settled) cell.outcome = Outcome::breaks;
}

void chart(const TriangleMesh& mesh, StabilityCell& cell) {
  const TriangleMesh welded = weld_equal(mesh).mesh;
  const SegmentationResult result = segment_charts(welded);
  const auto topologies = chart_topologies(welded, result.charts);
  const auto no_disks =
      std::count_if(topologies.begin(), topologies.end(), [](const ChartTopology& t) { return !t.is_disk(); });
  cell.error = 0;
  cell.residual = static_cast<double>(no_disks);
  cell.note = fmt::format("{} charts", result.charts.count);
  if (no_disks > 0) cell.outcome = Outcome::breaks;
}

void simplify_within(const TriangleMesh& mesh, StabilityCell& cell) {
  const double diagonal = bounds_of(mesh).diagonal();
  SimplifyOptions options;
  options.tolerance_mm = k_tolerance * diagonal;
  const SimplifyResult result = simplify(mesh, options);
  cell.error = result.deviation.value() / diagonal;
  cell.iterations = static_cast<int>(result.trace.size());
  cell.note = fmt::format("{} of {} triangles, stop {}", result.mesh.triangles.size(), result.triangles_before,
                          to_string(result.stop));
  if (result.deviation.value() > options.tolerance_mm) cell.outcome = Outcome::breaks;
}

struct Method {
  const char* name;
  void (*run)(const TriangleMesh&, StabilityCell&);
};
constexpr std::array<Method, 4> k_methods = {
    {{"weld", weld_soup}, {"repair", repair_soup}, {"charts", chart}, {"simplification", simplify_within}}};

}  // namespace

StabilitySuite mesh_stability(const StabilityRun& run) {
  StabilitySuite suite{
      "mesh", "Meshing", "largest deviation over the diagonal", "defects left by repair, charts that are no disks", {}};
  fill_suite(
      suite, run, extreme_meshes(), k_methods,
      [](const Method& method, const NamedMesh& input, StabilityCell& cell) { method.run(input.mesh, cell); },
      triangles_of);
  return suite;
}

}  // namespace papilla
