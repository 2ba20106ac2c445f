// SPDX-License-Identifier: MIT
#include "papilla/param/automatic.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "best_map.hpp"
#include "chart_solvers.hpp"
#include "check_mesh.hpp"
#include "map_descent.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using namespace param_detail;

constexpr const char* k_function = "flatten_automatic";
constexpr double k_degree = std::numbers::pi / 180;
constexpr double k_no_limit = std::numeric_limits<double>::infinity();

void check(const AutomaticOptions& options) {
  const auto refuse = [](const std::string& what) { throw InvalidInput(std::string(k_function) + ": " + what); };
  if (!(options.developable_deg >= 0 && options.developable_deg <= 360))
    refuse("developable_deg is " + std::to_string(options.developable_deg) + ", it must lie in [0, 360]");
  if (!(options.developable_excess >= 0))
    refuse("developable_excess is " + std::to_string(options.developable_excess) + ", it must not be negative");
  if (!(options.flat_deg >= 0 && options.flat_deg <= 60))
    refuse("flat_deg is " + std::to_string(options.flat_deg) + ", it must lie in [0, 60]");
}

/// The angle at corner k of a triangle.
double corner_angle(const ChartSurface& chart, const Triangle& t, std::size_t k) {
  const Vec3 at = chart.positions[t[k]];
  const Vec3 p = chart.positions[t[(k + 1) % 3]] - at, q = chart.positions[t[(k + 2) % 3]] - at;
  return std::atan2(norm(cross(p, q)), dot(p, q));
}

/// The largest |2π - sum of angles| over the interior vertices, in degrees.
double largest_defect_deg(const ChartSurface& chart) {
  std::vector<double> angle(chart.positions.size(), 0);
  std::vector<char> border(angle.size(), 0);
  for (std::size_t t = 0; t < chart.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      angle[chart.triangles[t][k]] += corner_angle(chart, chart.triangles[t], k);
      if (chart.across[t][k] == k_no_triangle)
        border[chart.triangles[t][k]] = border[chart.triangles[t][(k + 1) % 3]] = 1;
    }
  double largest = 0;
  for (std::size_t v = 0; v < angle.size(); ++v)
    if (!border[v] && angle[v] > 0) largest = std::max(largest, std::abs(2 * std::numbers::pi - angle[v]));
  return largest / k_degree;
}

struct Flatness {
  Vec3 normal;               ///< Mean, of length 1; zero when there is none.
  double largest_deg = 180;  ///< Between it and the normal of a triangle.
};

Flatness flatness_of(const ChartSurface& chart) {
  Flatness flatness;
  const auto normal = [&](const Triangle& t) {
    return cross(chart.positions[t[1]] - chart.positions[t[0]], chart.positions[t[2]] - chart.positions[t[0]]);
  };
  Vec3 sum;
  for (const Triangle& t : chart.triangles) sum = sum + normal(t);
  if (!(norm(sum) > 0)) return flatness;
  flatness.normal = normalized(sum);
  flatness.largest_deg = 0;
  for (const Triangle& t : chart.triangles) {
    const Vec3 n = normal(t);
    if (!(norm(n) > 0)) continue;
    const double angle = std::atan2(norm(cross(flatness.normal, n)), dot(flatness.normal, n)) / k_degree;
    flatness.largest_deg = std::max(flatness.largest_deg, angle);
  }
  return flatness;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Tries one method after the other.
class ChartMapper {
 public:
  ChartMapper(const ChartSurface& chart, const AutomaticOptions& options, SharedProgress& mapped)
      : chart_(chart), options_(options), mapped_(mapped) {}

  ChartMap run() {
    const double defect = largest_defect_deg(chart_);
    if (defect <= options_.developable_deg) {
      SolvedMap map = solve_lscm_hermitian(to_unit(chart_).surface);
      const std::string reason = "angles around interior vertices miss 2π by " + number(defect) + "° at most";
      if (map.failure.empty() && take(std::move(map.uv), 4 + options_.developable_excess, {"exact", reason}))
        return std::move(result_);
    }
    const Flatness flatness = flatness_of(chart_);
    if (flatness.largest_deg <= options_.flat_deg &&
        take(projected(to_unit(chart_).surface, flatness.normal), k_no_limit,
             {"planar", "normals are within " + number(flatness.largest_deg) + "° of their mean"}))
      return std::move(result_);
    return best(defect);
  }

 private:
  /// @param most of the mean energy.
  bool take(std::vector<Vec2> uv, double most, MethodChoice choice) {
    normalise(chart_, options_.up, true, uv);
    if (!map_failure(chart_, uv).empty()) return false;
    const std::vector<RestShape> rest = rest_shapes(chart_.positions, chart_.triangles);
    const SymmetricDirichlet energy(rest);
    const double sum = total_energy({chart_.triangles, &energy}, uv);
    if (!(sum <= most * area_of(chart_))) return false;
    mapped_.add(static_cast<double>(chart_.triangles.size()));
    result_.trace = {{clock_.seconds(), sum}};
    result_.uv = std::move(uv);
    result_.choice = std::move(choice);
    return true;
  }

  ChartMap best(double defect) {
    ChartMap map = map_best(chart_, options_.best, mapped_);
    map.choice = {"best", defect <= options_.developable_deg
                              ? "curved too little to show at any vertex, but neither developable nor nearly flat"
                              : "angles around an interior vertex miss 2π by " + number(defect) + "°"};
    return map;
  }

  const ChartSurface& chart_;
  const AutomaticOptions& options_;
  SharedProgress& mapped_;
  Stopwatch clock_;
  ChartMap result_;
};

}  // namespace

AutomaticResult flatten_automatic(const TriangleMesh& mesh, const ChartSet& charts, const AutomaticOptions& options) {
  check(options);
  check_best_options(options.best, k_function);
  if (options.best.nearby) check_uv(mesh, *options.best.nearby, k_function);
  std::vector<MethodChoice> choices(charts.count);
  DriverOptions driver = driver_options(k_function, options.best);
  driver.up = options.up;
  driver.unfold = false;
  driver.choices = &choices;
  SharedProgress mapped(options.best.progress, "map", static_cast<double>(mesh.triangles.size()));
  AutomaticResult result;
  result.flattening = flatten_charts(
      mesh, charts, [&](const ChartSurface& chart) { return ChartMapper(chart, options, mapped).run(); }, driver);
  result.choices = choices_of_charts(std::move(choices));
  return result;
}

}  // namespace papilla
