// SPDX-License-Identifier: MIT
#include "papilla/param/maillot.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <string>

#include "chart_driver.hpp"
#include "chart_solvers.hpp"
#include "maillot_energy.hpp"
#include "map_descent.hpp"
#include "multilevel_map.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using namespace param_detail;

constexpr const char* k_function = "flatten_maillot";

/// An energy of this much of the surface's area is none: lengths and areas are right to a millionth. Without weight on
/// lengths every disk gets there, and the energy then falls by a large part of itself for ever.
constexpr double k_exact = 1e-12;

void check(const MaillotOptions& options) {
  const auto refuse = [](const std::string& what) { throw InvalidInput(std::string(k_function) + ": " + what); };
  if (!(options.length_weight >= 0 && options.length_weight <= 1))
    refuse("length_weight is " + std::to_string(options.length_weight) + ", it must lie between 0 and 1");
  if (!(options.tolerance > 0 && options.tolerance < 1))
    refuse("tolerance is " + std::to_string(options.tolerance) + ", it must lie between 0 and 1");
  if (options.max_iterations < 0)
    refuse("max_iterations is " + std::to_string(options.max_iterations) + ", it must not be negative");
  if (!(options.distortion_limit == 0 || options.distortion_limit >= 1))
    refuse("distortion_limit is " + std::to_string(options.distortion_limit) + ", it must be 0 or at least 1");
}

struct StartMap {
  std::vector<Vec2> uv;
  std::string failure, name;
};

SolvedMap conformal_start(const ChartSurface& unit) {
  SolvedMap map = solve_lscm_hermitian(unit);
  if (map.failure.empty()) normalise(unit, UpAxis::z, true, map.uv);
  return map;
}

SolvedMap planar_start(const ChartSurface& unit) {
  Vec3 normal;
  for (const Triangle& t : unit.triangles)
    normal = normal + cross(unit.positions[t[1]] - unit.positions[t[0]], unit.positions[t[2]] - unit.positions[t[0]]);
  if (!(norm(normal) > 0)) return {{}, "the chart has no mean normal"};
  return {projected(unit, normalized(normal)), {}};
}

/// The start that was asked for, or the one that is valid on every disk where that is none.
StartMap start_map(const ChartSurface& unit, const MaillotOptions& options) {
  std::string name = "from coarse to fine";
  if (options.start != MaillotStart::coarse_to_fine) {
    const bool is_planar = options.start == MaillotStart::planar;
    const std::string asked = is_planar ? "the planar map" : "the conformal map";
    SolvedMap map = is_planar ? planar_start(unit) : conformal_start(unit);
    if (map.failure.empty() && !options.allow_flips) map.failure = map_failure(unit, map.uv);
    if (map.failure.empty()) return {std::move(map.uv), {}, "from " + asked};
    name += ", as " + asked + " is none (" + map.failure + ")";
  }
  MultilevelOptions coarse;
  coarse.deadline = options.deadline;
  coarse.only_when_rough = true;  // the energy has no wall: from a bad map it leads to another bad one
  MultilevelMap map = map_multilevel(unit, coarse);
  return {std::move(map.uv), std::move(map.failure), std::move(name)};
}

/// What the start and what the descent did.
std::string told_shares(const StartMap& start, double before, double after) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), ": E %.4g mm² before the descent, %.4g mm² after", before, after);
  return start.name + text.data();
}

/// The symmetric Dirichlet energy of the map after scaling it to the area of the surface.
double scaled_dirichlet(std::span<const Triangle> triangles, const std::vector<RestShape>& rest,
                        std::span<const Vec2> uv) {
  double area = 0, uv_area = 0, forward = 0, backward = 0;
  for (std::size_t t = 0; t < rest.size(); ++t) {
    const auto [a, b, c] = triangles[t];
    const Jacobian j = jacobian(rest[t], uv[b] - uv[a], uv[c] - uv[a]);
    const double det = j.determinant();
    area += rest[t].area, uv_area += rest[t].area * det;
    forward += rest[t].area * j.squared(), backward += rest[t].area * j.squared() / (det * det);
  }
  return area / uv_area * forward + uv_area / area * backward;
}

std::vector<BorderPair> border_pairs(const ChartSurface& chart) {
  std::vector<BorderPair> border;
  for (const auto& loop : border_loops(chart))
    for (std::size_t i = 0; i < loop.size(); ++i) border.push_back({loop[i], loop[(i + 1) % loop.size()]});
  return border;
}

ChartMap map_chart(const ChartSurface& chart, const MaillotOptions& options) {
  const Stopwatch clock;
  const UnitChart unit = to_unit(chart);
  StartMap start = start_map(unit.surface, options);
  ChartMap map{std::move(start.uv), std::move(start.failure), StopReason::direct, {}};
  if (!map.failure.empty()) return map;
  const double started = clock.seconds(), square_mm = 1 / (unit.scale * unit.scale);
  const std::span<const Index> across(unit.surface.across.front().data(), 3 * unit.surface.across.size());
  const MaillotEnergy energy(unit.surface.positions, unit.surface.triangles, across, options.length_weight);
  DescentOptions descent;
  descent.max_iterations = options.max_iterations;
  descent.tolerance = options.tolerance;
  descent.negligible = k_exact * area_of(unit.surface);
  descent.deadline = options.deadline;
  descent.allow_flips = options.allow_flips;
  descent.reuse_factor = true;
  DescentProblem problem{unit.surface.triangles, &energy};
  if (!options.allow_flips) {
    const std::vector<RestShape> rest = rest_shapes(unit.surface.positions, unit.surface.triangles);
    const BorderBarrier border(border_pairs(unit.surface), map.uv, 0);
    const double limit = options.distortion_limit * scaled_dirichlet(unit.surface.triangles, rest, map.uv);
    problem.accept = [&, rest, border, limit](std::span<const Vec2> uv) {
      return (limit == 0 || scaled_dirichlet(unit.surface.triangles, rest, uv) <= limit) && border.is_simple(uv);
    };
  }
  const DescentResult result = options.solver == MaillotSolver::gradient_descent
                                   ? descend_gradient(problem, map.uv, descent)
                                   : descend(problem, map.uv, descent);
  map.stop = result.stop;
  for (const TraceSample& s : result.trace) map.trace.push_back({started + s.seconds, square_mm * s.error});
  for (Vec2& p : map.uv) p = (1 / unit.scale) * p;
  map.choice = {"maillot", told_shares(start, map.trace.front().error, map.trace.back().error)};
  return map;
}

/// Energies of the finished map, and what went wrong with it.
void measure(const TriangleMesh& mesh, MaillotResult& result) {
  const CornerAttribute<Vec2>& uv = result.flattening.uv;
  TriangleMesh cut;  // corners that share uv share positions
  cut.positions.resize(uv.values.size());
  cut.triangles = uv.indices;
  for (std::size_t t = 0; t < uv.indices.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) cut.positions[uv.indices[t][k]] = mesh.corner(t, static_cast<int>(k));
  const MaillotEnergy::Sums sums = MaillotEnergy(cut.positions, cut.triangles, 0.5).sums(cut.triangles, uv.values);
  result.length_energy = sums.length;
  result.area_energy = sums.area;
  result.squared_edges = sums.squared_edges;
  for (const Triangle& t : uv.indices)
    result.flipped += cross(uv.values[t[1]] - uv.values[t[0]], uv.values[t[2]] - uv.values[t[0]]) < 0;
}

}  // namespace

MaillotOptions maillot_as_written(MaillotStart start, double length_weight) {
  MaillotOptions options;
  options.start = start;
  options.length_weight = length_weight;
  options.solver = MaillotSolver::gradient_descent;
  options.distortion_limit = 0;
  options.allow_flips = true;
  return options;
}

MaillotResult flatten_maillot(const TriangleMesh& mesh, const ChartSet& charts, const MaillotOptions& options) {
  check(options);
  std::atomic<std::size_t> overlapping{0};
  const auto method = [&](const ChartSurface& chart) {
    ChartMap map = map_chart(chart, options);
    if (options.allow_flips && map.failure.empty() && !map_failure(chart, map.uv).empty()) ++overlapping;
    return map;
  };
  DriverOptions driver = driver_options(k_function, options);
  driver.scale_to_area = false;
  driver.allow_flips = options.allow_flips;
  driver.error_per_area = false;
  std::vector<MethodChoice> choices(charts.count);
  driver.choices = &choices;
  MaillotResult result;
  result.flattening = flatten_charts(mesh, charts, method, driver);
  result.start_energy = result.flattening.trace.front().error;
  result.end_energy = result.flattening.trace.back().error;
  result.choices = choices_of_charts(std::move(choices));
  result.invalid_charts = overlapping;
  measure(mesh, result);
  return result;
}

}  // namespace papilla
