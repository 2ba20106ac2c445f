// SPDX-License-Identifier: MIT
#include "papilla/pipeline/unwrap_method.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>

#include "papilla/core/error.hpp"
#include "papilla/core/glob.hpp"

namespace papilla {
namespace {

Index nearest_vertex(const TriangleMesh& mesh, Vec3 position) {
  Index nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (Index v = 0; v < mesh.positions.size(); ++v) {
    const Vec3 d = mesh.positions[v] - position;
    if (dot(d, d) < least) least = dot(d, d), nearest = v;
  }
  return nearest;
}

struct Neighbours {
  std::vector<Index> first, to;
  explicit Neighbours(const TriangleMesh& mesh) : first(mesh.positions.size() + 2, 0), to(6 * mesh.triangles.size()) {
    for (const Triangle& t : mesh.triangles)
      for (const Index v : t) first[v + 2] += 2;
    for (std::size_t v = 2; v < first.size(); ++v) first[v] += first[v - 1];
    for (const Triangle& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k)
        for (const std::size_t l : {(k + 1) % 3, (k + 2) % 3}) to[first[t[k] + 1]++] = t[l];
  }
};

/// Dijkstra's shortest path over edges, without its first vertex; empty when there is none.
std::vector<Index> path_between(const TriangleMesh& mesh, const Neighbours& neighbours, Index from, Index to) {
  std::vector<double> distance(mesh.positions.size(), std::numeric_limits<double>::infinity());
  std::vector<Index> before(mesh.positions.size(), from);
  using Reached = std::pair<double, Index>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
  distance[from] = 0;
  queue.push({0, from});
  while (!queue.empty() && queue.top().second != to) {
    const auto [reached, v] = queue.top();
    queue.pop();
    if (reached > distance[v]) continue;
    for (Index i = neighbours.first[v]; i < neighbours.first[v + 1]; ++i) {
      const Index w = neighbours.to[i];
      const double next = reached + norm(mesh.positions[w] - mesh.positions[v]);
      if (next < distance[w]) distance[w] = next, before[w] = v, queue.push({next, w});
    }
  }
  std::vector<Index> path;
  if (queue.empty()) return path;
  for (Index v = to; v != from; v = before[v]) path.push_back(v);
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace

bool is_for_part(const std::string& pattern, const std::string& part) {
  return pattern.empty() || matches_glob(pattern, part);
}

PlacedGrain grain_of(const std::vector<PlacedGrain>& grains, const std::string& part) {
  const auto find = [&](bool by_name) {
    return std::find_if(grains.begin(), grains.end(), [&](const PlacedGrain& grain) {
      return grain.part.empty() != by_name && is_for_part(grain.part, part);
    });
  };
  auto grain = find(true);
  if (grain == grains.end()) grain = find(false);
  return grain == grains.end() ? PlacedGrain{} : *grain;
}

std::vector<std::string> named_parts(const MethodOptions& options) {
  std::vector<std::string> patterns;
  const auto add = [&](const auto& placed) {
    for (const auto& p : placed)
      if (!p.part.empty()) patterns.push_back(p.part);
  };
  add(options.grains), add(options.pins), add(options.iso_lines);
  return patterns;
}

LevyPin pin_on(const TriangleMesh& mesh, const PlacedPin& pin) { return {nearest_vertex(mesh, pin.position), pin.uv}; }

LevyIsoLine iso_line_on(const TriangleMesh& mesh, const PlacedIsoLine& line) {
  const Neighbours neighbours(mesh);
  LevyIsoLine result;
  result.is_u = line.is_u;
  result.value = line.value;
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    const Index next = nearest_vertex(mesh, line.points[i]);
    if (i == 0) {
      result.vertices.push_back(next);
      continue;
    }
    if (next == result.vertices.back()) continue;
    const std::vector<Index> path = path_between(mesh, neighbours, result.vertices.back(), next);
    if (path.empty()) {
      const Vec3 p = line.points[i];
      throw InvalidInput(fmt::format("iso line: no edges lead to its point[{}] ({:g}, {:g}, {:g})", i, p.x, p.y, p.z));
    }
    result.vertices.insert(result.vertices.end(), path.begin(), path.end());
  }
  return result;
}

}  // namespace papilla
