// SPDX-License-Identifier: MIT
#include "map_level.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "chunks.hpp"
#include "corners_of_vertices.hpp"
#include "map_descent.hpp"
#include "vertex_step.hpp"

namespace papilla::param_detail {
namespace {

void view_from(Index v, const MapLevel& level, const CornersOfVertices& corners, std::vector<CornerView>& ring) {
  ring.clear();
  const Vec2 at = level.uv[v];
  for (const Index c : corners.of(v)) {
    const Triangle& t = level.triangles[c / 3];
    const std::size_t k = c % 3;
    ring.push_back(corner_view(level.rest[c / 3], k, level.uv[t[(k + 1) % 3]] - at, level.uv[t[(k + 2) % 3]] - at));
  }
}

/// Moves a vertex unless the border would run into itself.
void move(Index v, Vec2 place, MapLevel& level, std::optional<BorderGuard>& guard) {
  if (guard && guard->on_border(v)) {
    if (!guard->may_move(v, place)) return;
    guard->move(v, place);
  }
  level.uv[v] = place;
}

double area_of(std::span<const RestShape> shapes) {
  return sum_over(shapes.size(), [&](std::size_t t) { return shapes[t].area; });
}

std::vector<Sliver> slivers_of(std::span<const Vec3> positions, const MapLevel& level) {
  const double least = least_edge(positions, level.triangles);
  std::vector<std::vector<Sliver>> of_chunk((level.triangles.size() + k_chunk - 1) / k_chunk);
  for_chunks(level.triangles.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    for (auto t = static_cast<Index>(begin); t < end; ++t) {
      const auto [a, b, c] = level.triangles[t];
      const RestShape own = rest_shape(positions[a], positions[b], positions[c], least);
      if (level.rest[t].area > own.area) of_chunk[chunk].push_back({t, own});
    }
  });
  std::vector<Sliver> slivers;
  for (const std::vector<Sliver>& some : of_chunk) slivers.insert(slivers.end(), some.begin(), some.end());
  return slivers;
}

/// Which vertices have a neighbour in a later chunk of vertices: they stay until chunks have been moved side by side.
std::vector<char> find_waiting(const MapLevel& level, const CornersOfVertices& corners) {
  std::vector<char> waits(level.uv.size());
  for_chunks(waits.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      waits[v] = std::ranges::any_of(corners.of(v), [&](Index c) {
        return std::ranges::any_of(level.triangles[c / 3], [&](Index w) { return w >= end; });
      });
  });
  return waits;
}

}  // namespace

MapLevel current_level(const DiskHierarchy& hierarchy, std::span<const Vec3> positions, std::span<const Vec2> uv,
                       LeastArea least_area) {
  constexpr Index nowhere = ~Index{0};
  MapLevel level;
  std::vector<Index> number(positions.size(), nowhere);
  std::vector<Vec3> own_positions;
  const std::size_t vertices = hierarchy.vertex_count();
  level.vertices.reserve(vertices), own_positions.reserve(vertices), level.uv.reserve(vertices);
  level.triangles.reserve(2 * vertices);  // A disk has fewer.
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
  if (std::isfinite(least_area.shape)) level.slivers = slivers_of(own_positions, level);
  level.area = area_of(level.rest);
  level.border = border_of(level.triangles, level.vertices.size());
  return level;
}

MapLevel whole_level(const ChartSurface& chart, std::vector<Vec2> uv) {
  MapLevel level;
  level.vertices.resize(uv.size());
  std::iota(level.vertices.begin(), level.vertices.end(), Index{0});
  level.triangles.assign(chart.triangles.begin(), chart.triangles.end());
  level.rest = rest_shapes(chart.positions, chart.triangles);
  level.area = area_of(level.rest);
  level.border = border_of(level.triangles, uv.size());
  level.uv = std::move(uv);
  return level;
}

BorderBarrier barrier_of(const MapLevel& level) {
  return barrier_of(level.border, level.uv, level.area, level.triangles.size());
}

int relax(MapLevel& level, int sweeps, double tolerance, bool guarded) {
  const CornersOfVertices corners(level.triangles, level.vertices.size());
  std::optional<BorderGuard> guard;
  if (guarded) guard.emplace(level.border, level.uv);
  const SymmetricDirichlet energy(level.rest);
  const DescentProblem problem{level.triangles, &energy, nullptr};
  double value = total_energy(problem, level.uv);
  const auto relax_vertex = [&](Index v, std::vector<CornerView>& ring) {
    view_from(v, level, corners, ring);
    move(v, level.uv[v] + corner_step(ring), level, guard);
  };
  // What watches the border sees one move after the other.
  const std::vector<char> waits = guarded ? std::vector<char>(level.uv.size(), 1) : find_waiting(level, corners);
  std::vector<CornerView> ring;
  int sweep = 0;
  while (sweep++ < sweeps) {
    for_chunks(level.uv.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      std::vector<CornerView> own_ring;
      for (auto v = static_cast<Index>(begin); v < end; ++v)
        if (!waits[v]) relax_vertex(v, own_ring);
    });
    for (Index v = 0; v < level.uv.size(); ++v)
      if (waits[v]) relax_vertex(v, ring);
    const double before = value;
    value = total_energy(problem, level.uv);
    if (!(before - value > tolerance * value)) break;
  }
  return std::min(sweep, sweeps);
}

void restore_slivers(MapLevel& level, bool guarded) {
  if (level.slivers.empty()) return;
  for (const Sliver& sliver : level.slivers) {
    RestShape& rest = level.rest[sliver.triangle];
    level.area += sliver.shape.area - rest.area;
    rest = sliver.shape;
  }
  const CornersOfVertices corners(level.triangles, level.vertices.size());
  std::optional<BorderGuard> guard;
  if (guarded) guard.emplace(level.border, level.uv);
  std::vector<CornerView> ring;
  for (const Sliver& sliver : level.slivers) {
    const RestShape& s = sliver.shape;
    const std::array<Vec2, 3> own{Vec2{0, 0}, Vec2{s.base(), 0}, Vec2{s.along(), s.height()}};
    const auto squared_edge = [&](std::size_t k) {
      const Vec2 edge = own[(k + 1) % 3] - own[k];
      return dot(edge, edge);
    };
    std::size_t k = 0;
    for (const std::size_t other : {std::size_t{1}, std::size_t{2}})
      if (squared_edge(other) > squared_edge(k)) k = other;
    // The similarity that takes the longest edge to its image.
    const Vec2 edge = own[(k + 1) % 3] - own[k], apex = own[(k + 2) % 3] - own[k];
    const double x = dot(edge, apex) / dot(edge, edge), y = cross(edge, apex) / dot(edge, edge);
    const Triangle& t = level.triangles[sliver.triangle];
    const Vec2 from = level.uv[t[k]], image = level.uv[t[(k + 1) % 3]] - from;
    const Index v = t[(k + 2) % 3];
    const Vec2 place = from + x * image + y * Vec2{-image.y, image.x};
    view_from(v, level, corners, ring);
    if (corner_energy(ring, place - level.uv[v]) < corner_energy(ring, {})) move(v, place, level, guard);
  }
}

}  // namespace papilla::param_detail
