// SPDX-License-Identifier: MIT

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "evaluate/kinds.hpp"
#include "papilla/meshing/simplify.hpp"
#include "papilla/param/projections.hpp"

namespace papilla {
namespace {

constexpr std::array<std::size_t, 4> k_divisors = {64, 16, 4, 1};
constexpr std::size_t k_least_triangles = 8;
constexpr double k_growth = 1.5;  // Simplifying takes longer than the map.

Vec2 centroid_uv(const CornerAttribute<Vec2>& uv, std::size_t t) {
  const auto& [a, b, c] = uv.indices[t];
  return (1.0 / 3) * (uv.values[a] + uv.values[b] + uv.values[c]);
}

/// Every triangle split at its centroid: the new vertex gets the triangle's normal, the others keep theirs.
TriangleMesh split_at_centroids(const TriangleMesh& mesh) {
  TriangleMesh split;
  split.positions = mesh.positions;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto middle = static_cast<Index>(split.positions.size());
    split.positions.push_back((1.0 / 3) * (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)));
    const auto& [a, b, c] = mesh.triangles[t];
    split.triangles.insert(split.triangles.end(), {{a, b, middle}, {b, c, middle}, {c, a, middle}});
  }
  return split;
}

/// The panorama's u goes on over its ends.
Vec2 difference(Vec2 a, Vec2 b, EnvironmentMap map) {
  const Vec2 d = a - b;
  return map == EnvironmentMap::equal_area ? Vec2{std::remainder(d.x, 1), d.y} : d;
}

double interpolation_error(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv,
                           const EnvironmentOptions& options) {
  const CornerAttribute<Vec2> exact = environment_uv(split_at_centroids(mesh), options);
  double sum = 0, total = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const double area = norm(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
    sum += area * norm(difference(exact.values[mesh.positions.size() + t], centroid_uv(uv, t), options.map));
    total += area;
  }
  return total > 0 ? sum / total : 0;
}

}  // namespace

EvaluationRun environment_run(const TriangleMesh& mesh, EnvironmentMap map, const std::string& map_name,
                              const std::string& input, const Budget& budget) {
  EvaluationRun run{"environment", map_name, input, "mean error of uv in the middles of triangles, in pictures", {},
                    "direct"};
  EnvironmentOptions options;
  options.map = map;
  Ladder ladder(budget, k_growth);
  for (const std::size_t divisor : k_divisors) {
    if (!ladder.next()) break;
    SimplifyOptions fewer;
    fewer.target_triangles = std::max(mesh.triangles.size() / divisor, k_least_triangles);
    const TriangleMesh coarse = divisor == 1 ? mesh : simplify(mesh, fewer).mesh;
    const Stopwatch clock;
    const CornerAttribute<Vec2> uv = environment_uv(coarse, options);
    const double seconds = clock.seconds();
    run.trace.push_back({seconds, interpolation_error(coarse, uv, options)});
    run.notes += fmt::format("{} triangles: {:.3g}; ", coarse.triangles.size(), run.trace.back().error);
  }
  if (run.trace.empty()) run.stop = k_time_spent;
  run.notes += "a preview of reflections, no map of the surface: it has no distortion to measure";
  return run;
}

}  // namespace papilla
