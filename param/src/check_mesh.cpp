// SPDX-License-Identifier: MIT
#include "check_mesh.hpp"

#include <cmath>
#include <string>

#include "papilla/core/error.hpp"

namespace papilla::param_detail {
namespace {

/// A million kilometres in micrometres: areas fit a float, fourth powers and their sums a double.
constexpr double k_largest_coordinate = 1e15;

[[noreturn]] void fail(std::string_view function, const std::string& what) {
  throw InvalidInput(std::string(function) + ": " + what);
}

}  // namespace

void check_mesh(const TriangleMesh& mesh, std::string_view function) {
  if (mesh.triangles.size() >= (std::size_t{1} << 30))
    fail(function,
         "the mesh has " + std::to_string(mesh.triangles.size()) + " triangles, at most 2^30 - 1 can be numbered");
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3& p = mesh.positions[v];
    // A comparison with NaN is false.
    if (!(std::abs(p.x) <= k_largest_coordinate && std::abs(p.y) <= k_largest_coordinate &&
          std::abs(p.z) <= k_largest_coordinate))
      fail(function, "position[" + std::to_string(v) + "] is not a finite number below 1e15");
  }
  const std::size_t count = mesh.positions.size();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    if (triangle[0] >= count || triangle[1] >= count || triangle[2] >= count)
      fail(function, "triangle[" + std::to_string(t) + "] names a vertex that does not exist");
  }
}

void check_charts(const TriangleMesh& mesh, const ChartSet& charts, std::string_view function) {
  if (charts.of_triangle.size() != mesh.triangles.size())
    fail(function, "charts.of_triangle has " + std::to_string(charts.of_triangle.size()) + " entries for " +
                       std::to_string(mesh.triangles.size()) + " triangles");
  for (std::size_t t = 0; t < charts.of_triangle.size(); ++t)
    if (charts.of_triangle[t] >= charts.count)
      fail(function, "charts.of_triangle[" + std::to_string(t) + "] is " + std::to_string(charts.of_triangle[t]) +
                         ", the chart set has " + std::to_string(charts.count) + " charts");
}

void check_uv(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv, std::string_view function) {
  if (uv.indices.size() != mesh.triangles.size())
    fail(function, "uv has " + std::to_string(uv.indices.size()) + " entries for " +
                       std::to_string(mesh.triangles.size()) + " triangles");
  for (std::size_t i = 0; i < uv.values.size(); ++i)
    if (!(std::abs(uv.values[i].x) <= k_largest_coordinate && std::abs(uv.values[i].y) <= k_largest_coordinate))
      fail(function, "uv[" + std::to_string(i) + "] is not a finite number below 1e15");
  for (std::size_t t = 0; t < uv.indices.size(); ++t)
    for (const Index i : uv.indices[t])
      if (i >= uv.values.size()) fail(function, "triangle[" + std::to_string(t) + "] names a uv that does not exist");
}

}  // namespace papilla::param_detail
