// SPDX-License-Identifier: MIT
#include "map_level.hpp"

#include <algorithm>
#include <optional>

#include "corners_of_vertices.hpp"
#include "map_descent.hpp"
#include "vertex_step.hpp"

namespace papilla::param_detail {
namespace {

/// Edges that have no opposite one, in the order of the triangles.
std::vector<BorderPair> border_of(const MapLevel& level) {
  const CornersOfVertices corners(level.triangles, level.vertices.size());
  const auto next = [&](Index corner) { return level.triangles[corner / 3][(corner % 3 + 1) % 3]; };
  std::vector<BorderPair> border;
  for (const Triangle& t : level.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index from = t[k], to = t[(k + 1) % 3];
      const auto around = corners.of(to);
      if (std::none_of(around.begin(), around.end(), [&](Index c) { return next(c) == from; }))
        border.push_back({from, to});
    }
  return border;
}

}  // namespace

MapLevel current_level(const DiskHierarchy& hierarchy, std::span<const Vec3> positions, std::span<const Vec2> uv,
                       double least_area) {
  constexpr Index nowhere = ~Index{0};
  MapLevel level;
  std::vector<Index> number(positions.size(), nowhere);
  std::vector<Vec3> own_positions;
  for (Index t = 0; t < hierarchy.triangles().size(); ++t) {
    if (!hierarchy.alive(t)) continue;
    Triangle local{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Index v = hierarchy.triangles()[t][k];
      if (number[v] == nowhere) {
        number[v] = static_cast<Index>(level.vertices.size());
        level.vertices.push_back(v);
        own_positions.push_back(positions[v]);
        level.uv.push_back(uv[v]);
      }
      local[k] = number[v];
    }
    level.triangles.push_back(local);
  }
  level.rest = rest_shapes(own_positions, level.triangles, least_area);
  for (const RestShape& rest : level.rest) level.area += rest.area;
  level.border = border_of(level);
  return level;
}

int relax(MapLevel& level, int sweeps, double tolerance, bool guarded) {
  const CornersOfVertices corners(level.triangles, level.vertices.size());
  std::optional<BorderGuard> guard;
  if (guarded) guard.emplace(level.border, level.uv);
  const SymmetricDirichlet energy(level.rest);
  const DescentProblem problem{level.triangles, &energy, nullptr};
  double value = total_energy(problem, level.uv);
  std::vector<CornerView> ring;
  int sweep = 0;
  while (sweep++ < sweeps) {
    for (Index v = 0; v < level.uv.size(); ++v) {
      ring.clear();
      const Vec2 at = level.uv[v];
      for (const Index c : corners.of(v)) {
        const Triangle& t = level.triangles[c / 3];
        const std::size_t k = c % 3;
        ring.push_back(corner_view(level.rest[c / 3], k, level.uv[t[(k + 1) % 3]] - at, level.uv[t[(k + 2) % 3]] - at));
      }
      const Vec2 place = at + corner_step(ring);
      if (guard && guard->on_border(v)) {
        if (!guard->may_move(v, place)) continue;
        guard->move(v, place);
      }
      level.uv[v] = place;
    }
    const double before = value;
    value = total_energy(problem, level.uv);
    if (!(before - value > tolerance * value)) break;
  }
  return std::min(sweep, sweeps);
}

}  // namespace papilla::param_detail
