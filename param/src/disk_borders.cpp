// SPDX-License-Identifier: MIT
#include "disk_borders.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <numbers>
#include <queue>
#include <utility>

#include "adjacency.hpp"

namespace papilla::param_detail {
namespace {

/// Edges of the border count as at least this fraction of their mean length.
constexpr double k_least_border_edge = 0.3;

using Loop = std::vector<Index>;

std::vector<Loop> loops_of(std::span<const BorderPair> border, std::size_t vertices) {
  std::vector<Index> after(vertices, k_no_triangle);
  for (const auto& [from, to] : border) after[from] = to;
  std::vector<Loop> loops;
  for (Index start = 0; start < vertices; ++start) {
    if (after[start] == k_no_triangle) continue;
    Loop& loop = loops.emplace_back();
    for (Index v = start; after[v] != k_no_triangle;) {
      loop.push_back(v);
      v = std::exchange(after[v], k_no_triangle);
    }
  }
  return loops;
}

std::vector<double> angles(const std::vector<double>& lengths) {
  double total = 0, mean = 0;
  for (const double length : lengths) mean += length / static_cast<double>(lengths.size());
  for (const double length : lengths) total += std::max(length, k_least_border_edge * mean);
  std::vector<double> angle;
  double at = 0;
  for (const double length : lengths) {
    angle.push_back(2 * std::numbers::pi * at / total);
    at += std::max(length, k_least_border_edge * mean);
  }
  return angle;
}

}  // namespace

FilledDisk fill_holes(const MapLevel& level, std::span<const Vec3> positions) {
  FilledDisk disk;
  disk.triangles = level.triangles;
  for (const Index v : level.vertices) disk.where.push_back(positions[v]);
  std::vector<Loop> loops = loops_of(level.border, level.vertices.size());
  std::vector<double> longest;
  std::size_t outer = 0;
  disk.border_length = -1;
  for (std::size_t l = 0; l < loops.size(); ++l) {
    std::vector<double> lengths;
    double sum = 0;
    for (std::size_t i = 0; i < loops[l].size(); ++i) {
      lengths.push_back(norm(disk.where[loops[l][(i + 1) % loops[l].size()]] - disk.where[loops[l][i]]));
      sum += lengths.back();
    }
    if (sum > disk.border_length) disk.border_length = sum, longest = std::move(lengths), outer = l;
  }
  for (std::size_t l = 0; l < loops.size(); ++l) {
    if (l == outer) continue;
    const auto middle = static_cast<Index>(disk.where.size());
    disk.where.push_back(disk.where[loops[l].front()]);
    for (std::size_t i = 0; i < loops[l].size(); ++i)
      disk.triangles.push_back({loops[l][(i + 1) % loops[l].size()], loops[l][i], middle});
  }
  disk.border = std::move(loops[outer]);
  disk.angle = angles(longest);
  return disk;
}

BorderDistance border_distance(const FilledDisk& disk) {
  const std::size_t count = disk.where.size();
  std::vector<std::vector<Index>> neighbors(count);
  for (const Triangle& t : disk.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      neighbors[t[k]].push_back(t[(k + 1) % 3]);
      neighbors[t[(k + 1) % 3]].push_back(t[k]);
    }
  BorderDistance result;
  result.depth.assign(count, std::numeric_limits<double>::infinity());
  result.before.resize(count);
  using Reached = std::pair<double, Index>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
  for (const Index v : disk.border) result.depth[v] = 0, result.before[v] = v, queue.emplace(0, v);
  while (!queue.empty()) {
    const auto [distance, v] = queue.top();
    queue.pop();
    if (distance > result.depth[v]) continue;
    for (const Index w : neighbors[v])
      if (const double by_v = distance + norm(disk.where[w] - disk.where[v]); by_v < result.depth[w])
        result.depth[w] = by_v, result.before[w] = v, queue.emplace(by_v, w);
  }
  return result;
}

}  // namespace papilla::param_detail
