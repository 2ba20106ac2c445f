// SPDX-License-Identifier: MIT
#include "papilla/param/lscm.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "check_mesh.hpp"
#include "lscm_solvers.hpp"
#include "papilla/core/error.hpp"
#include "sheet_overlap.hpp"

namespace papilla {
namespace {

using namespace param_detail;

constexpr const char* k_function = "flatten_lscm";

/// A triangle is without area when its doubled area is below this fraction of its longest edge squared.
constexpr double k_no_area = 1e-12;

/// The doubled uv area, as a fraction of the longest uv edge squared, by which a triangle without area in
/// space may be turned over by rounding.
constexpr double k_rounding_area = 1e-9;

double longest_squared(Vec3 p, Vec3 q) { return std::max({dot(p, p), dot(q, q), dot(q - p, q - p)}); }
double longest_squared(Vec2 p, Vec2 q) { return std::max({dot(p, p), dot(q, q), dot(q - p, q - p)}); }

/// What one chart came to.
struct MappedChart {
  CornerAttribute<Vec2> uv;           ///< Triangles in the order of the chart.
  std::vector<std::uint32_t> pieces;  ///< Chart number within this one, per triangle; empty: all 0.
  std::uint32_t piece_count = 1;
  std::string failure;  ///< Why LSCM gave no map.
  bool wrong_topology = false;
  double area = 0, conformal_energy = 0;
};

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

/// Why the chart can't be flattened in one piece, or nothing.
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
  if (twice_genus != 0) return "it has a handle (genus " + std::to_string(twice_genus / 2) + ")";
  return {};
}

double area_of(const ChartSurface& chart) {
  double area = 0;
  for (const Triangle& t : chart.triangles)
    area +=
        0.5 * norm(cross(chart.positions[t[1]] - chart.positions[t[0]], chart.positions[t[2]] - chart.positions[t[0]]));
  return area;
}

/// Scales to equal area and turns v into the grain direction; does nothing for a map without area.
void normalise(const ChartSurface& chart, GrainUp up, double area, std::vector<Vec2>& uv) {
  double uv_area = 0;
  Vec2 grain;
  for (const Triangle& t : chart.triangles) {
    const Vec3 p = chart.positions[t[1]] - chart.positions[t[0]], q = chart.positions[t[2]] - chart.positions[t[0]];
    const Vec2 m = uv[t[1]] - uv[t[0]], n = uv[t[2]] - uv[t[0]];
    uv_area += 0.5 * cross(m, n);
    const Vec3 doubled = cross(p, q);
    const double square = dot(doubled, doubled);
    if (!(square > k_no_area * k_no_area * longest_squared(p, q) * longest_squared(p, q))) continue;
    // d = x p + y q has (x, y) from the two cross products; its image is x m + y n. Weighted by area / size of the
    // image.
    const Vec3 d = grain_direction(normalized(doubled), up);
    const double x = dot(cross(d, q), doubled) / square, y = dot(cross(p, d), doubled) / square;
    const Vec2 image = x * m + y * n;
    const double size = norm(image);
    if (size > 0) grain = grain + (std::sqrt(square) * norm(d) / size) * image;
  }
  if (!(uv_area > 0)) return;
  const double scale = std::sqrt(area / uv_area), length = norm(grain);
  // Turns `grain` to (0, 1): multiplication with (y + i x) / length.
  const Vec2 turn = length > 1e-6 * area ? Vec2{grain.y / length, grain.x / length} : Vec2{1, 0};
  const Vec2 origin = uv.front();
  for (Vec2& z : uv) {
    const Vec2 w = scale * (z - origin);
    z = {w.x * turn.x - w.y * turn.y, w.x * turn.y + w.y * turn.x};
  }
}

/// How the map fails to be a valid one, or nothing.
std::string map_failure(const ChartSurface& chart, const std::vector<Vec2>& uv) {
  if (!std::all_of(uv.begin(), uv.end(), [](Vec2 p) { return is_finite(p); })) return "the solution is not finite";
  std::size_t flipped = 0;
  for (const Triangle& t : chart.triangles) {
    const Vec3 p = chart.positions[t[1]] - chart.positions[t[0]], q = chart.positions[t[2]] - chart.positions[t[0]];
    const Vec2 m = uv[t[1]] - uv[t[0]], n = uv[t[2]] - uv[t[0]];
    const bool has_area = norm(cross(p, q)) > k_no_area * longest_squared(p, q);
    const double signed_area = cross(m, n);
    flipped += has_area ? !(signed_area > 0) : signed_area < -k_rounding_area * longest_squared(m, n);
  }
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

/// Σ A (σ1 - σ2)² = Σ A (|J|² - 2 det J), from the scaled map.
double conformal_energy(const ChartSurface& chart, const std::vector<Vec2>& uv) {
  double energy = 0;
  for (const Triangle& t : chart.triangles) {
    const Vec3 p = chart.positions[t[1]] - chart.positions[t[0]], q = chart.positions[t[2]] - chart.positions[t[0]];
    const Vec2 m = uv[t[1]] - uv[t[0]], n = uv[t[2]] - uv[t[0]];
    const double area = norm(cross(p, q));
    if (!(area > k_no_area * longest_squared(p, q))) continue;
    // |J|² A / 2 = the cotangent form of the Dirichlet energy, written without angles.
    const double dirichlet = (dot(m, m) * dot(q, q) - 2 * dot(m, n) * dot(p, q) + dot(n, n) * dot(p, p)) / (2 * area);
    energy += dirichlet - cross(m, n);
  }
  return std::max(energy, 0.0);
}

MappedChart map_chart(const ChartSurface& chart, const LscmOptions& options) {
  MappedChart result;
  result.failure = topology_failure(chart);
  result.wrong_topology = !result.failure.empty();
  result.area = area_of(chart);
  if (result.wrong_topology) return result;
  if (!(result.area > 0)) {
    result.failure = "it has no area";
    return result;
  }
  ConformalMap map = options.solver == LscmSolver::cgal ? solve_lscm_cgal(chart) : solve_lscm_hermitian(chart);
  result.failure = map.failure;
  if (!result.failure.empty()) return result;
  normalise(chart, options.up, result.area, map.uv);
  result.failure = map_failure(chart, map.uv);
  if (!result.failure.empty()) return result;
  result.conformal_energy = conformal_energy(chart, map.uv);
  result.uv = {std::move(map.uv), chart.triangles};
  return result;
}

void project_instead(const ChartSurface& chart, const LscmOptions& options, MappedChart& result) {
  TriangleMesh mesh;
  mesh.positions = chart.positions;
  mesh.triangles = chart.triangles;
  TriplanarOptions projection = options.projection;
  projection.up = options.up;
  TriplanarResult projected = flatten_triplanar(mesh, projection);
  result.uv = std::move(projected.flattening.uv);
  result.pieces = std::move(projected.flattening.charts.of_triangle);
  result.piece_count = projected.flattening.charts.count;
}

void append(const MappedChart& chart, std::span<const Index> triangles, Flattening& result) {
  const auto first_value = static_cast<Index>(result.uv.values.size());
  result.uv.values.insert(result.uv.values.end(), chart.uv.values.begin(), chart.uv.values.end());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& corners = chart.uv.indices[i];
    result.uv.indices[triangles[i]] = {first_value + corners[0], first_value + corners[1], first_value + corners[2]};
    result.charts.of_triangle[triangles[i]] = result.charts.count + (chart.pieces.empty() ? 0 : chart.pieces[i]);
  }
  result.charts.count += chart.piece_count;
}

[[noreturn]] void refuse(std::uint32_t number, Index triangle, const MappedChart& chart) {
  const std::string what = std::string(k_function) + ": chart[" + std::to_string(number) + "] (triangle[" +
                           std::to_string(triangle) + "]): " + chart.failure;
  if (chart.wrong_topology) throw InvalidInput(what);
  throw SolverFailure(what);
}

}  // namespace

namespace param_detail {

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

}  // namespace param_detail

Flattening flatten_lscm(const TriangleMesh& mesh, const ChartSet& charts, const LscmOptions& options) {
  check_mesh(mesh, k_function);
  check_charts(mesh, charts, k_function);
  const Stopwatch clock;
  const Adjacency across = connect_triangles(mesh);
  const TrianglesOfCharts members = sort_by_chart(charts.of_triangle, charts.count);
  const ChartCutter cutter(mesh, across, charts);
  std::vector<MappedChart> mapped(charts.count);
  oneapi::tbb::parallel_for(std::uint32_t{0}, charts.count, [&](std::uint32_t c) {
    if (members.of(c).empty()) return;
    const ChartSurface surface = cutter.cut(c, members.of(c));
    mapped[c] = map_chart(surface, options);
    if (!mapped[c].failure.empty() && options.fall_back) project_instead(surface, options, mapped[c]);
  });

  Flattening result;
  result.uv.indices.resize(mesh.triangles.size());
  result.charts.of_triangle.resize(mesh.triangles.size());
  double area = 0, energy = 0;
  for (std::uint32_t c = 0; c < charts.count; ++c) {
    const auto own = members.of(c);
    if (own.empty()) continue;
    if (mapped[c].failure.empty()) {
      area += mapped[c].area;
      energy += mapped[c].conformal_energy;
    } else {
      if (!options.fall_back) refuse(c, own.front(), mapped[c]);
      result.notes.push_back({c, "chart[" + std::to_string(c) + "] (triangle[" + std::to_string(own.front()) +
                                     "]): " + mapped[c].failure + "; projected as " +
                                     std::to_string(mapped[c].piece_count) + " planar pieces instead"});
    }
    append(mapped[c], own, result);
    mapped[c] = {};
  }
  result.charts.seam_length_mm = seam_length(mesh, across, result.charts.of_triangle);
  result.trace.push_back({clock.seconds(), area > 0 ? energy / area : 0});
  return result;
}

}  // namespace papilla
