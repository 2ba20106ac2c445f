// SPDX-License-Identifier: MIT
#include "papilla/meshing/weld.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <string>

#include "check_mesh.hpp"
#include "edge_table.hpp"
#include "exact_positions.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/core/units.hpp"
#include "papilla/meshing/mesh_bounds.hpp"
#include "point_tree.hpp"
#include "repair_steps.hpp"
#include "triangle_shape.hpp"

namespace papilla {
namespace {

using namespace detail;

void check_options(const WeldOptions& options) {
  const auto require = [](bool valid, const char* name, double value) {
    if (!valid) throw InvalidInput(std::string("weld: ") + name + " " + std::to_string(value) + " is out of range");
  };
  const double tolerance = options.tolerance_mm.value_or(0);
  require(tolerance >= 0 && std::isfinite(tolerance), "tolerance_mm", tolerance);
  require(options.relative_tolerance >= 0 && options.relative_tolerance < 1, "relative_tolerance",
          options.relative_tolerance);
  require(options.feature_fraction >= 0 && options.feature_fraction < 0.5, "feature_fraction",
          options.feature_fraction);
}

/// How far each boundary vertex may move; negative for inner vertices.
std::vector<double> reach_of_vertices(const TriangleMesh& mesh, const EdgeTable& edges, const WeldReach& most) {
  const std::vector<Index> boundary = edges.boundary_halfedges();
  if (boundary.empty()) return {};
  std::vector<double> reach(mesh.positions.size(), -1);
  for (const Index h : boundary)
    reach[from_vertex(mesh.triangles, h)] = reach[to_vertex(mesh.triangles, h)] = most.tolerance_mm;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[next_corner(k)];
      if (reach[a] < 0 && reach[b] < 0) continue;
      const double length = norm(mesh.positions[b] - mesh.positions[a]);
      if (length <= most.shortest_feature_mm) continue;
      reach[a] = std::min(reach[a], most.feature_fraction * length);
      reach[b] = std::min(reach[b], most.feature_fraction * length);
    }
  return reach;
}

/// The vertex each vertex moves onto; itself when it stays.
std::vector<Index> nearest_earlier(std::span<const Vec3> positions, const std::vector<double>& reach) {
  std::vector<Index> members;
  for (Index v = 0; v < reach.size(); ++v)
    if (reach[v] >= 0) members.push_back(v);
  const PointTree tree(positions, members);
  std::vector<Index> target(positions.size());
  std::iota(target.begin(), target.end(), Index{0});
  for (const Index v : members) {
    double nearest = std::numeric_limits<double>::infinity();
    tree.near_point(positions[v], reach[v], [&](Index p, const Vec3& place) {
      const double distance = norm(place - positions[v]);
      if (p >= v || distance > reach[v] || distance > reach[p] || target[p] != p) return;
      if (distance < nearest || (distance == nearest && p < target[v])) {
        nearest = distance;
        target[v] = p;
      }
    });
  }
  return target;
}

/// The vertex each vertex moves onto; empty when all stay.
std::vector<Index> weld_targets(const TriangleMesh& mesh, const EdgeTable& edges, const WeldReach& most) {
  if (!(most.tolerance_mm > 0)) return {};
  const std::vector<double> reach = reach_of_vertices(mesh, edges, most);
  if (reach.empty()) return {};
  std::vector<Index> target = nearest_earlier(mesh.positions, reach);
  for (Index v = 0; v < target.size(); ++v)
    if (target[v] != v) return target;
  return {};
}

/// Makes positions of the same number one vertex; returns how many were merged.
std::size_t merge(TriangleMesh& mesh, const ExactPositions& exact) {
  Values<Vec3> positions;
  positions.reserve(exact.first.size());
  for (const Index v : exact.first) positions.push_back(mesh.positions[v]);
  const std::size_t merged = mesh.positions.size() - positions.size();
  mesh.positions = std::move(positions);
  for (Triangle& t : mesh.triangles)
    for (Index& v : t) v = exact.of_position[v];
  return merged;
}

/// The number that a file in single precision holds for x; x where that is infinite.
double stored(double x, double unit) noexcept {
  const double scaled = unit * x;
  return std::abs(scaled) <= double{std::numeric_limits<float>::max()} ? static_cast<double>(static_cast<float>(scaled))
                                                                       : x;
}

}  // namespace

namespace detail {

std::size_t merge_equal(TriangleMesh& mesh) { return merge(mesh, exact_positions(mesh)); }

std::size_t merge_stored_equal(TriangleMesh& mesh, double& max_deviation_mm) {
  std::size_t merged = 0;
  for (const double unit : {1.0, k_metres_per_mm}) {
    Values<Vec3> positions;
    positions.reserve(mesh.positions.size());
    for (const Vec3& p : mesh.positions) positions.push_back({stored(p.x, unit), stored(p.y, unit), stored(p.z, unit)});
    positions.swap(mesh.positions);
    const ExactPositions equal = exact_positions(mesh);
    positions.swap(mesh.positions);
    if (equal.first.size() == mesh.positions.size()) continue;
    for (Index v = 0; v < mesh.positions.size(); ++v)
      if (equal.of_position[v] != k_none)
        max_deviation_mm =
            std::max(max_deviation_mm, norm(mesh.positions[v] - mesh.positions[equal.first[equal.of_position[v]]]));
    merged += merge(mesh, equal);
  }
  return merged;
}

bool weld_borders(TriangleMesh& mesh, const EdgeTable& edges, const WeldReach& reach, WeldResult& result) {
  const std::vector<Index> target = weld_targets(mesh, edges, reach);
  if (target.empty()) return false;
  for (Index v = 0; v < target.size(); ++v) {
    if (target[v] == v) continue;
    ++result.merged_near;
    result.max_deviation_mm = std::max(result.max_deviation_mm, norm(mesh.positions[v] - mesh.positions[target[v]]));
  }
  for (Triangle& t : mesh.triangles)
    for (Index& v : t) v = target[v];
  result.repeated += drop_repeated_corners(mesh);
  drop_unused(mesh);
  return true;
}

bool has_near_borders(const TriangleMesh& mesh, const EdgeTable& edges, const WeldReach& reach) {
  return !weld_targets(mesh, edges, reach).empty();
}

}  // namespace detail

WeldResult weld_equal(TriangleMesh mesh) {
  check_mesh(mesh, "weld_equal");
  WeldResult result;
  result.merged_equal = merge_equal(mesh);
  result.mesh = std::move(mesh);
  return result;
}

WeldResult weld(TriangleMesh mesh, const WeldOptions& options) {
  check_options(options);
  WeldResult result = weld_equal(std::move(mesh));
  const double diagonal = bounds_of(result.mesh).diagonal();
  result.tolerance_mm = options.tolerance_mm.value_or(options.relative_tolerance * diagonal);
  weld_borders(result.mesh, EdgeTable(result.mesh.triangles, result.mesh.positions.size()),
               {result.tolerance_mm, options.feature_fraction, k_degenerate_altitude * diagonal}, result);
  return result;
}

std::vector<WeldStep> weld_ladder(const TriangleMesh& mesh, std::span<const double> tolerances_mm,
                                  const WeldOptions& options) {
  std::vector<WeldStep> steps;
  for (std::size_t i = 0; i < tolerances_mm.size(); ++i) {
    if (!(tolerances_mm[i] >= 0) || !std::isfinite(tolerances_mm[i]))
      throw InvalidInput("weld_ladder: tolerances_mm[" + std::to_string(i) + "] is negative or not finite");
    WeldOptions at_step = options;
    at_step.tolerance_mm = tolerances_mm[i];
    TriangleMesh copy = mesh;
    const Stopwatch clock;
    const WeldResult welded = weld(std::move(copy), at_step);
    WeldStep step;
    step.seconds = clock.seconds();
    step.tolerance_mm = tolerances_mm[i];
    step.max_deviation_mm = welded.max_deviation_mm;
    step.triangles = welded.mesh.triangles.size();
    const detail::EdgeTable edges(welded.mesh.triangles, welded.mesh.positions.size());
    for (std::size_t e = 0; e < edges.size(); ++e) {
      step.boundary_edges += edges.halfedges(e).size() == 1 ? 1u : 0u;
      step.nonmanifold_edges += edges.halfedges(e).size() > 2 ? 1u : 0u;
    }
    steps.push_back(step);
  }
  return steps;
}

}  // namespace papilla
