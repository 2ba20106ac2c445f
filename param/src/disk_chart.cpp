// SPDX-License-Identifier: MIT
#include "disk_chart.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "chunks.hpp"
#include "sheet_overlap.hpp"

namespace papilla::param_detail {
namespace {

/// A triangle is without area when its doubled area is below this fraction of its longest edge squared.
constexpr double k_no_area = 1e-12;

/// The doubled uv area, as a fraction of the longest uv edge squared, by which a triangle without area in
/// space may be turned over by rounding.
constexpr double k_rounding_area = 1e-9;

double longest_squared(Vec3 p, Vec3 q) { return std::max({dot(p, p), dot(q, q), dot(q - p, q - p)}); }
double longest_squared(Vec2 p, Vec2 q) { return std::max({dot(p, p), dot(q, q), dot(q - p, q - p)}); }

bool is_connected(const ChartSurface& chart) {
  std::vector<char> seen(chart.triangles.size(), 0);
  std::vector<Index> stack{0};
  seen[0] = 1;
  std::size_t count = 0;
  while (!stack.empty()) {
    const Index t = stack.back();
    stack.pop_back();
    ++count;
    for (const Index other : chart.across[t])
      if (other != k_no_triangle && !seen[other]) seen[other] = 1, stack.push_back(other);
  }
  return count == chart.triangles.size();
}

}  // namespace

std::vector<std::vector<Index>> border_loops(const ChartSurface& chart) {
  std::vector<Index> after(chart.positions.size(), k_no_triangle);
  for (std::size_t t = 0; t < chart.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (chart.across[t][k] == k_no_triangle) after[chart.triangles[t][k]] = chart.triangles[t][(k + 1) % 3];
  std::vector<std::vector<Index>> loops;
  for (Index start = 0; start < after.size(); ++start) {
    if (after[start] == k_no_triangle) continue;
    std::vector<Index>& loop = loops.emplace_back();
    for (Index v = start; after[v] != k_no_triangle;) {
      loop.push_back(v);
      v = std::exchange(after[v], k_no_triangle);
    }
  }
  const auto length = [&](const std::vector<Index>& loop) {
    double sum = 0;
    for (std::size_t i = 0; i < loop.size(); ++i)
      sum += norm(chart.positions[loop[(i + 1) % loop.size()]] - chart.positions[loop[i]]);
    return sum;
  };
  if (loops.size() > 1) {
    const auto longest = std::max_element(loops.begin(), loops.end(),
                                          [&](const auto& a, const auto& b) { return length(a) < length(b); });
    std::iter_swap(loops.begin(), longest);
  }
  return loops;
}

std::string topology_failure(const ChartSurface& chart) {
  if (!is_connected(chart)) return "it is not connected over manifold, consistently oriented edges";
  const auto loops = border_loops(chart);
  if (loops.empty()) return "it is closed";
  std::size_t border_edges = 0;
  for (const auto& loop : loops) border_edges += loop.size();
  const auto vertices = static_cast<std::int64_t>(chart.positions.size());
  const auto faces = static_cast<std::int64_t>(chart.triangles.size());
  const std::int64_t edges = (3 * faces + static_cast<std::int64_t>(border_edges)) / 2;
  const std::int64_t twice_genus = 2 - static_cast<std::int64_t>(loops.size()) - (vertices - edges + faces);
  for (const auto& loop : loops)
    if (loop.size() < 3) return "it has a border of " + std::to_string(loop.size()) + " vertices";
  if (twice_genus != 0) return "it has a handle (genus " + std::to_string(twice_genus / 2) + ")";
  return {};
}

double area_of(const ChartSurface& chart) {
  return sum_over(chart.triangles.size(), [&](std::size_t t) {
    const auto [a, b, c] = chart.triangles[t];
    return 0.5 * norm(cross(chart.positions[b] - chart.positions[a], chart.positions[c] - chart.positions[a]));
  });
}

void normalise(const ChartSurface& chart, UpAxis up, bool scale, std::vector<Vec2>& uv) {
  // The map's area, and the direction that the grain has in it.
  const Vec3 sums = sum_over(chart.triangles.size(), [&](std::size_t i) {
    const Triangle& t = chart.triangles[i];
    const Vec3 p = chart.positions[t[1]] - chart.positions[t[0]], q = chart.positions[t[2]] - chart.positions[t[0]];
    const Vec2 m = uv[t[1]] - uv[t[0]], n = uv[t[2]] - uv[t[0]];
    const double uv_area = 0.5 * cross(m, n);
    const Vec3 doubled = cross(p, q);
    const double square = dot(doubled, doubled);
    if (!(square > k_no_area * k_no_area * longest_squared(p, q) * longest_squared(p, q))) return Vec3{uv_area, 0, 0};
    // d = x p + y q has (x, y) from the two cross products; its image is x m + y n. Weighted by area / size of the
    // image.
    const Vec3 d = grain_direction(normalized(doubled), up);
    const double x = dot(cross(d, q), doubled) / square, y = dot(cross(p, d), doubled) / square;
    const Vec2 image = x * m + y * n;
    const double size = norm(image), weight = size > 0 ? std::sqrt(square) * norm(d) / size : 0;
    return Vec3{uv_area, weight * image.x, weight * image.y};
  });
  const double area = area_of(chart), uv_area = sums.x;
  const Vec2 grain{sums.y, sums.z};
  if (!(uv_area > 0)) return;
  const double factor = scale ? std::sqrt(area / uv_area) : 1.0, length = norm(grain);
  // Turns `grain` to (0, 1): multiplication with (y + i x) / length.
  const Vec2 turn = length > 1e-6 * area ? Vec2{grain.y / length, grain.x / length} : Vec2{1, 0};
  const Vec2 origin = uv.front();
  for_chunks(uv.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Vec2 w = factor * (uv[v] - origin);
      uv[v] = {w.x * turn.x - w.y * turn.y, w.x * turn.y + w.y * turn.x};
    }
  });
}

std::string map_failure(const ChartSurface& chart, const std::vector<Vec2>& uv) {
  if (!std::all_of(uv.begin(), uv.end(), [](Vec2 p) { return is_finite(p); })) return "the solution is not finite";
  const std::size_t flipped = sum_over(chart.triangles.size(), [&](std::size_t i) -> std::size_t {
    const Triangle& t = chart.triangles[i];
    const Vec3 p = chart.positions[t[1]] - chart.positions[t[0]], q = chart.positions[t[2]] - chart.positions[t[0]];
    const Vec2 m = uv[t[1]] - uv[t[0]], n = uv[t[2]] - uv[t[0]];
    const bool has_area = norm(cross(p, q)) > k_no_area * longest_squared(p, q);
    const double signed_area = cross(m, n);
    return has_area ? !(signed_area > 0) : signed_area < -k_rounding_area * longest_squared(m, n);
  });
  if (flipped > 0)
    return std::to_string(flipped) + " of " + std::to_string(chart.triangles.size()) +
           " triangles are flipped or collapsed";
  std::vector<BorderEdge> border;
  for (const auto& loop : border_loops(chart))
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Index from = loop[i], to = loop[(i + 1) % loop.size()];
      border.push_back({from, to, uv[from], uv[to]});
    }
  if (border_proves_injective(border)) return {};
  PlaneSheet sheet{{}, chart.across};
  for (const Triangle& t : chart.triangles) sheet.triangles.push_back({uv[t[0]], uv[t[1]], uv[t[2]]});
  return overlaps_itself(sheet) ? "the chart overlaps itself" : "";
}

std::vector<Vec2> projected(const ChartSurface& chart, Vec3 normal) {
  const Vec3 other = std::abs(normal.z) < 0.8 ? Vec3{0, 0, 1} : Vec3{1, 0, 0};
  const Vec3 u = normalized(cross(other, normal)), v = cross(normal, u);
  std::vector<Vec2> uv;
  uv.reserve(chart.positions.size());
  for (const Vec3& p : chart.positions) uv.push_back({dot(u, p), dot(v, p)});
  return uv;
}

UnitChart to_unit(const ChartSurface& chart) {
  UnitChart unit{chart, 1};
  const double area = area_of(chart);
  if (area > 0) unit.scale = 1 / std::sqrt(area);
  const Vec3 origin = chart.positions.front();
  for (Vec3& p : unit.surface.positions) p = unit.scale * (p - origin);
  for (auto& corners : unit.surface.nearby)
    for (Vec2& p : corners) p = unit.scale * p;
  return unit;
}

}  // namespace papilla::param_detail
