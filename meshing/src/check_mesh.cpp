// SPDX-License-Identifier: MIT
#include "check_mesh.hpp"

#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "mesh_attributes.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"

namespace papilla::detail {
namespace {

[[noreturn]] void fail(std::string_view function, std::string_view what, std::size_t place) {
  throw InvalidInput(std::string(function) + ": " + std::string(what) + "[" + std::to_string(place) + "]");
}

void check_indices(std::span<const Triangle> triangles, std::size_t limit, std::string_view function,
                   std::string_view what, bool may_lack) {
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const Index v : triangles[t])
      if (v >= limit && !(may_lack && v == k_no_value))
        fail(function, std::string(what) + " index " + std::to_string(v) + " out of range at triangle", t);
}

/// Keeps volumes and squared areas finite.
bool is_usable(const Vec3& p) noexcept {
  constexpr double k_largest = 1e100;
  return std::abs(p.x) <= k_largest && std::abs(p.y) <= k_largest && std::abs(p.z) <= k_largest;
}

}  // namespace

void check_mesh(const TriangleMesh& mesh, std::string_view function) {
  const std::size_t count = mesh.triangles.size();
  constexpr std::size_t k_limit = std::numeric_limits<Index>::max();
  if (count > k_limit / 3 - 1 || mesh.positions.size() >= k_limit) fail(function, "too many triangles", count);
  check_indices(mesh.triangles, mesh.positions.size(), function, "position", false);
  for (std::size_t t = 0; t < count; ++t)
    for (const Index v : mesh.triangles[t])
      if (!is_usable(mesh.positions[v])) fail(function, "coordinate is not finite or beyond 1e100 at positions", v);
  for_each_corner_attribute(mesh, [&](const auto& attribute) {
    if (attribute.empty()) return;
    if (attribute.indices.size() != count)
      fail(function, "attribute count differs from triangles", attribute.indices.size());
    check_indices(attribute.indices, attribute.values.size(), function, "attribute", true);
  });
  for_each_label(mesh, [&](const auto& labels) {
    if (!labels.empty() && labels.size() != count) fail(function, "label count differs from triangles", labels.size());
  });
}

void check_charts(const TriangleMesh& mesh, const ChartSet& charts, const char* function) {
  check_mesh(mesh, function);
  check_chart_numbers(mesh, charts, function);
}

void check_chart_numbers(const TriangleMesh& mesh, const ChartSet& charts, const char* function) {
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
  open_cuts(charts.cuts, opposite, function);
  return opposite;
}

void open_cuts(std::span<const Index> cuts, std::span<Index> opposite, const char* function) {
  for (const Index h : cuts) {
    if (h >= opposite.size() || opposite[h] == k_none)
      throw InvalidInput(std::string(function) + ": cut " + std::to_string(h) + " is no edge within a chart");
    opposite[opposite[h]] = k_none;
    opposite[h] = k_none;
  }
}

bool is_distance_position(const Vec3& p) noexcept {
  constexpr double k_largest = 1e15;
  const auto usable = [](double x) { return std::abs(x) <= k_largest; };
  return usable(p.x) && usable(p.y) && usable(p.z);
}

void check_distance_input(const TriangleMesh& mesh, std::string_view what, Bounds3& bounds) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const Index v : mesh.triangles[t]) {
      if (v >= mesh.positions.size())
        throw InvalidInput(std::string(what) + ".triangles[" + std::to_string(t) + "]: there is no position " +
                           std::to_string(v));
      const Vec3& p = mesh.positions[v];
      if (!is_distance_position(p))
        throw InvalidInput(std::string(what) + ".positions[" + std::to_string(v) + "]: " + k_no_distance_position);
      bounds.add(p);
    }
}

}  // namespace papilla::detail
