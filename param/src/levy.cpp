// SPDX-License-Identifier: MIT
#include "papilla/param/levy.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>
#include <string>
#include <utility>

#include "chart_driver.hpp"
#include "chart_solvers.hpp"
#include "levy_systems.hpp"
#include "papilla/core/error.hpp"
#include "papilla/param/levy_coupling.hpp"
#include "rest_shape.hpp"

namespace papilla {
namespace {

using namespace param_detail;

constexpr const char* k_function = "flatten_levy";

[[noreturn]] void refuse(const std::string& what) { throw InvalidInput(std::string(k_function) + ": " + what); }

void check_pins(const LevyOptions& options, std::size_t vertices) {
  for (std::size_t i = 0; i < options.pins.size(); ++i) {
    const LevyPin& pin = options.pins[i];
    const std::string name = "pins[" + std::to_string(i) + "]";
    if (pin.vertex >= vertices) refuse(name + " names vertex " + std::to_string(pin.vertex) + ", which does not exist");
    if (!is_finite(pin.uv)) refuse(name + " is not finite");
    for (std::size_t j = 0; j < i; ++j)
      if (options.pins[j].vertex == pin.vertex || options.pins[j].uv == pin.uv)
        refuse(name + " lies on top of pins[" + std::to_string(j) + "]");
  }
  for (std::size_t i = 0; i < options.iso_lines.size(); ++i) {
    const LevyIsoLine& line = options.iso_lines[i];
    const std::string name = "iso_lines[" + std::to_string(i) + "]";
    if (line.value && !std::isfinite(*line.value)) refuse(name + " has a value that is not finite");
    for (const Index v : line.vertices)
      if (v >= vertices) refuse(name + " names vertex " + std::to_string(v) + ", which does not exist");
  }
  if (options.border == LevyBorder::convex || options.pins.empty()) return;
  const auto differ = [&](double Vec2::*axis) {
    return std::any_of(options.pins.begin(), options.pins.end(),
                       [&](const LevyPin& p) { return p.uv.*axis != options.pins.front().uv.*axis; });
  };
  if (!differ(&Vec2::x) || !differ(&Vec2::y))
    refuse("a free border needs two pins or more that differ in u and in v, there are " +
           std::to_string(options.pins.size()) + " that do not");
}

void check(const LevyOptions& options, std::size_t vertices) {
  const auto weight = [](double value, const char* name) {
    if (!(value >= 0 && value <= 1e12))
      refuse(std::string(name) + " is " + std::to_string(value) + ", it must lie between 0 and 1e12");
  };
  weight(options.smoothness, "smoothness");
  weight(options.orthogonality, "orthogonality");
  weight(options.length, "length");
  if (options.smoothness + options.orthogonality + options.length == 0) refuse("all three weights are 0");
  if (!(options.tolerance > 0 && options.tolerance < 1))
    refuse("tolerance is " + std::to_string(options.tolerance) + ", it must lie between 0 and 1");
  if (options.max_rounds < 1) refuse("max_rounds is " + std::to_string(options.max_rounds) + ", it must be at least 1");
  if (options.length_rounds < 0)
    refuse("length_rounds is " + std::to_string(options.length_rounds) + ", it must not be negative");
  if (options.max_sweeps < 1) refuse("max_sweeps is " + std::to_string(options.max_sweeps) + ", it must be at least 1");
  if (options.border == LevyBorder::released && options.orthogonality == 0 && options.length == 0)
    refuse("a released border needs a weight on orthogonality or length");
  if (options.coupling == LevyCoupling::conformal)
    if (const std::string obstacle = conformal_obstacle(options, !options.iso_lines.empty()); !obstacle.empty())
      refuse("the coupling can't be conformal, " + obstacle + ": it can be orthogonal");
  check_pins(options, vertices);
}

/// What is held of a chart's map, in units of the chart.
struct Held {
  std::vector<std::pair<Index, Vec2>> points;  ///< Chart vertex and place.
  struct Line {
    std::vector<Index> vertices;
    bool is_u;
    std::optional<double> value;
  };
  std::vector<Line> lines;
  bool by_user = false;
};

/// The chart's vertices at each position of the mesh that is named, found by place: a chart holds positions only.
std::vector<Index> vertices_at(const ChartSurface& chart, Vec3 position) {
  std::vector<Index> found;
  for (Index v = 0; v < chart.positions.size(); ++v)
    if (chart.positions[v] == position) found.push_back(v);
  return found;
}

Held held_by_user(const TriangleMesh& mesh, const ChartSurface& chart, double scale, const LevyOptions& options) {
  Held held;
  for (const LevyPin& pin : options.pins)
    for (const Index v : vertices_at(chart, mesh.positions[pin.vertex])) held.points.push_back({v, scale * pin.uv});
  for (const LevyIsoLine& line : options.iso_lines) {
    Held::Line own{{}, line.is_u, line.value};
    if (own.value) *own.value *= scale;
    for (const Index v : line.vertices)
      for (const Index w : vertices_at(chart, mesh.positions[v])) own.vertices.push_back(w);
    if (!own.vertices.empty()) held.lines.push_back(std::move(own));
  }
  held.by_user = !held.points.empty() || !held.lines.empty();
  return held;
}

Unknowns unknowns_of(const Held& held, bool is_u, const std::vector<char>& fixed, const std::vector<Vec2>& uv) {
  const auto part = [&](Vec2 p) { return is_u ? p.x : p.y; };
  Unknowns unknowns;
  unknowns.of_vertex.assign(uv.size(), 0);
  for (const Vec2 p : uv) unknowns.value.push_back(part(p));
  for (std::size_t v = 0; v < fixed.size(); ++v)
    if (fixed[v]) unknowns.of_vertex[v] = Unknowns::k_fixed;
  std::vector<Index> leader(uv.size());
  for (Index v = 0; v < uv.size(); ++v) leader[v] = v;
  const auto find = [&](Index v) {
    while (leader[v] != v) v = leader[v] = leader[leader[v]];
    return v;
  };
  for (const Held::Line& line : held.lines) {
    if (line.is_u != is_u) continue;
    for (const Index v : line.vertices) {
      if (line.value) {
        unknowns.value[v] = *line.value;
        unknowns.of_vertex[v] = Unknowns::k_fixed;
      } else {
        leader[std::max(find(v), find(line.vertices.front()))] = std::min(find(v), find(line.vertices.front()));
      }
    }
  }
  for (const auto& [v, place] : held.points) {
    unknowns.value[v] = part(place);
    unknowns.of_vertex[v] = Unknowns::k_fixed;
  }
  // A fixed member fixes its whole line.
  for (Index v = 0; v < uv.size(); ++v)
    if (unknowns.of_vertex[v] == Unknowns::k_fixed && find(v) != v) {
      unknowns.of_vertex[find(v)] = Unknowns::k_fixed;
      unknowns.value[find(v)] = unknowns.value[v];
    }
  for (Index v = 0; v < uv.size(); ++v) {
    const Index first = find(v);
    if (first != v) {
      unknowns.of_vertex[v] = unknowns.of_vertex[first];
      unknowns.value[v] = unknowns.value[first];
    } else if (unknowns.of_vertex[v] != Unknowns::k_fixed) {
      unknowns.of_vertex[v] = unknowns.count++;
    }
  }
  return unknowns;
}

/// Puts the longest border on a circle of the chart's area and leaves the rest at its middle.
void to_circle(const ChartSurface& chart, std::vector<Vec2>& uv, std::vector<char>& fixed) {
  const auto loop = border_loops(chart).front();
  double total = 0;
  const auto length = [&](std::size_t i) {
    return norm(chart.positions[loop[(i + 1) % loop.size()]] - chart.positions[loop[i]]);
  };
  for (std::size_t i = 0; i < loop.size(); ++i) total += length(i);
  const double radius = std::sqrt(area_of(chart) / std::numbers::pi);
  double at = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const double angle = 2 * std::numbers::pi * at / total;
    uv[loop[i]] = radius * Vec2{std::cos(angle), std::sin(angle)};
    fixed[loop[i]] = 1;
    at += length(i);
  }
}

/// Moves, turns and scales so that a and b come to lie at pa and pb.
void fit(Index a, Index b, Vec2 pa, Vec2 pb, std::vector<Vec2>& uv) {
  const Vec2 from = uv[b] - uv[a], to = pb - pa, origin = uv[a];
  const double square = dot(from, from);
  if (!(square > 0)) return;
  const Vec2 turn{dot(from, to) / square, cross(from, to) / square};
  for (Vec2& p : uv) {
    const Vec2 d = p - origin;
    p = pa + Vec2{turn.x * d.x - turn.y * d.y, turn.x * d.y + turn.y * d.x};
  }
}

/// Scales u and v, each by the factor for which its gradients are nearest to 1: Σ A (|∇u|² + |∇u|⁻²) becomes least.
void scale_apart(const ChartSurface& chart, std::vector<Vec2>& uv) {
  const std::vector<RestShape> rest = rest_shapes(chart.positions, chart.triangles);
  Vec2 forward, backward;
  for (std::size_t t = 0; t < rest.size(); ++t) {
    const auto& [a, b, c] = chart.triangles[t];
    const Jacobian j = jacobian(rest[t], uv[b] - uv[a], uv[c] - uv[a]);
    const Vec2 squares{j.x.x * j.x.x + j.y.x * j.y.x, j.x.y * j.x.y + j.y.y * j.y.y};
    forward = forward + rest[t].area * squares;
    if (squares.x > 0 && squares.y > 0) backward = backward + rest[t].area * Vec2{1 / squares.x, 1 / squares.y};
  }
  if (!(forward.x > 0 && forward.y > 0 && backward.x > 0 && backward.y > 0)) return;
  const Vec2 scale{std::pow(backward.x / forward.x, 0.25), std::pow(backward.y / forward.y, 0.25)};
  for (Vec2& p : uv) p = {scale.x * p.x, scale.y * p.y};
}

/// Turns and moves a map so that lines of equal u run along v as well as may be, those of equal v along u, and lines
/// with a value to it.
void fit_to_lines(const std::vector<Held::Line>& lines, std::vector<Vec2>& uv) {
  Vec2 doubled;  // Σ length² (cos, sin) of twice the angle that is missing
  for (const Held::Line& line : lines) {
    const Vec2 d = uv[line.vertices.back()] - uv[line.vertices.front()];
    const Vec2 twice{d.x * d.x - d.y * d.y, -2 * d.x * d.y};
    doubled = doubled + (line.is_u ? -1.0 : 1.0) * twice;
  }
  const double angle = doubled == Vec2{} ? 0 : 0.5 * std::atan2(doubled.y, doubled.x);
  const Vec2 turn{std::cos(angle), std::sin(angle)};
  for (Vec2& p : uv) p = {turn.x * p.x - turn.y * p.y, turn.y * p.x + turn.x * p.y};
  for (double Vec2::*axis : {&Vec2::x, &Vec2::y}) {
    double miss = 0, count = 0;
    for (const Held::Line& line : lines)
      if (line.value && line.is_u == (axis == &Vec2::x))
        for (const Index v : line.vertices) miss += *line.value - uv[v].*axis, ++count;
    if (count > 0)
      for (Vec2& p : uv) p.*axis += miss / count;
  }
}

struct Sums {
  double smoothness = 0, orthogonality = 0, length = 0;
};

class LevyMap {
 public:
  LevyMap(const ChartSurface& chart, const LevyOptions& options, Held held)
      : chart_(chart),
        options_(options),
        held_(std::move(held)),
        smoothness_(options.smoothness > 0 || options.border != LevyBorder::free
                        ? smoothness_rows(chart, options.weights)
                        : LinearRows{}),
        length_(options.length > 0 ? length_rows(chart) : LinearRows{}),
        uv_(chart.positions.size()),
        fixed_(chart.positions.size(), 0) {}

  ChartMap run(Sums& sums) {
    ChartMap map;
    map.choice = choice();
    if (is_conformal()) {
      map.failure = solve_conformal();
      if (map.failure.empty() && options_.length > 0 && options_.length_rounds > 0)
        map.stop = even_then_long(map.trace);
      else
        map.trace.push_back({clock_.seconds(), total()});
      if (map.failure.empty() && held_.points.size() == 1) move_to_pin();
    } else if (options_.border == LevyBorder::convex) {
      map.failure = start_convex();
      if (map.failure.empty()) map.stop = is_linear() ? linear(map.trace) : alternate(map.trace);
    } else {
      map.failure = options_.border == LevyBorder::released ? start_released() : start_free();
      if (map.failure.empty()) map.stop = alternate(map.trace);
      if (free_scale_ && held_.points.empty()) scale_apart(chart_, uv_);
    }
    sums = sums_;
    if (map.failure.empty()) map.uv = std::move(uv_);
    return map;
  }

 private:
  bool is_conformal() const {
    return options_.coupling != LevyCoupling::orthogonal && conformal_obstacle(options_, !held_.lines.empty()).empty();
  }

  MethodChoice choice() const {
    if (is_conformal()) return {"levy conformal", "one linear system"};
    if (options_.border == LevyBorder::convex && is_linear()) return {"levy smooth", "smoothness alone has a weight"};
    return {"levy orthogonal", options_.coupling == LevyCoupling::orthogonal
                                   ? "as asked"
                                   : conformal_obstacle(options_, !held_.lines.empty())};
  }

  /// Those that fix a map's scale: one alone only fixes its place.
  std::vector<std::pair<Index, Vec2>> scaling_pins() const {
    return held_.points.size() >= 2 ? held_.points : std::vector<std::pair<Index, Vec2>>{};
  }

  std::string solve_conformal() {
    const ConformalTerms terms{options_.smoothness, options_.orthogonality, options_.length, &smoothness_, &length_};
    return solve_conformal_terms(chart_, terms, scaling_pins(), uv_) ? std::string()
                                                                     : "the Hermitian system is singular";
  }

  void move_to_pin() {
    normalise(chart_, options_.up, true, uv_);
    const Vec2 miss = held_.points.front().second - uv_[held_.points.front().first];
    for (Vec2& p : uv_) p = p + miss;
  }

  /// Lengths along the directions of the map that is even.
  StopReason even_then_long(Trace& trace) {
    LengthRounds rounds(chart_, options_.smoothness, smoothness_, scaling_pins(), uv_);
    trace.push_back({clock_.seconds(), rounds.length_error()});
    StopReason stop = StopReason::iteration_limit;
    for (int round = 0; round < options_.length_rounds && stop == StopReason::iteration_limit; ++round) {
      if (options_.deadline.passed())
        stop = StopReason::time_limit;
      else if (!rounds.advance())
        stop = StopReason::converged;
      else
        trace.push_back({clock_.seconds(), rounds.length_error()});
    }
    uv_ = rounds.uv();
    total();
    return stop;
  }

  std::string start_convex() {
    to_circle(chart_, uv_, fixed_);
    if (is_linear()) return {};
    return solve_smooth(chart_, smoothness_, options_.weights != LevyWeights::mean_value, uv_)
               ? std::string()
               : "the smoothness conditions are singular";
  }

  std::string start_free() {
    SolvedMap map = solve_lscm_hermitian(chart_);
    if (!map.failure.empty()) return map.failure;
    uv_ = std::move(map.uv);
    hold_freely();
    return {};
  }

  std::string start_released() {
    std::string failure = start_convex();
    fixed_.assign(fixed_.size(), 0);
    if (failure.empty()) hold_freely();
    return failure;
  }

  /// Puts the start of a free border where pins and lines want it, and holds what else has to be.
  void hold_freely() {
    normalise(chart_, options_.up, true, uv_);
    if (held_.points.size() >= 2) {
      fit(held_.points[0].first, held_.points[1].first, held_.points[0].second, held_.points[1].second, uv_);
    } else {
      if (held_.points.empty()) fit_to_lines(held_.lines, uv_);
      for (const auto& [v, place] : held_.points) {
        const Vec2 miss = place - uv_[v];
        for (Vec2& p : uv_) p = p + miss;
      }
      for (const bool is_u : {true, false}) hold_extremes(is_u);
    }
  }

  /// Unless two values are given: the vertices that lie farthest out, of those on no line, keep the coordinate that
  /// they are extreme in. Its scale comes afterwards when no value is given at all.
  void hold_extremes(bool is_u) {
    double Vec2::*axis = is_u ? &Vec2::x : &Vec2::y;
    std::vector<double> given;
    std::vector<char> on_line(uv_.size(), 0);
    for (const auto& [v, place] : held_.points) given.push_back(place.*axis), on_line[v] = 1;
    for (const Held::Line& line : held_.lines) {
      if (line.is_u != is_u) continue;
      if (line.value) given.push_back(*line.value);
      for (const Index v : line.vertices) on_line[v] = 1;
    }
    free_scale_ = free_scale_ && given.empty();
    if (!given.empty() && *std::max_element(given.begin(), given.end()) > *std::min_element(given.begin(), given.end()))
      return;
    Index low = k_no_triangle, high = k_no_triangle;
    for (Index v = 0; v < uv_.size(); ++v) {
      if (on_line[v]) continue;
      if (low == k_no_triangle || uv_[v].*axis < uv_[low].*axis) low = v;
      if (high == k_no_triangle || uv_[v].*axis > uv_[high].*axis) high = v;
    }
    if (low == k_no_triangle) return;
    for (const Index v : {low, high}) held_.lines.push_back({{v}, is_u, uv_[v].*axis});
  }

  bool is_linear() const { return options_.orthogonality == 0 && options_.length == 0 && !held_.by_user; }

  /// Convex border, R alone: R = 0 is reached.
  StopReason linear(Trace& trace) {
    if (options_.solver == LevySolver::gauss_seidel) return alternate(trace);
    solve_smooth(chart_, smoothness_, options_.weights != LevyWeights::mean_value, uv_);
    trace.push_back({clock_.seconds(), total()});
    return StopReason::direct;
  }

  StopReason alternate(Trace& trace) {
    Unknowns u = unknowns_of(held_, true, fixed_, uv_), v = unknowns_of(held_, false, fixed_, uv_);
    take(u, v);
    const LevySystem::Weights weights{options_.smoothness, options_.orthogonality, options_.length};
    LevySystem for_u(chart_, smoothness_, length_, weights, u), for_v(chart_, smoothness_, length_, weights, v);
    double before = total();
    trace.push_back({clock_.seconds(), before});
    for (int round = 0; round < options_.max_rounds; ++round) {
      if (options_.deadline.passed()) return StopReason::time_limit;
      const bool u_done = advance(for_u, v.value, u), v_done = advance(for_v, u.value, v);
      take(u, v);
      const double after = total();
      trace.push_back({clock_.seconds(), after});
      if (options_.orthogonality == 0)
        return options_.solver == LevySolver::direct ? StopReason::direct
               : u_done && v_done                    ? StopReason::converged
                                                     : StopReason::iteration_limit;
      if (!(before - after > options_.tolerance * after)) return StopReason::converged;
      before = after;
    }
    return StopReason::iteration_limit;
  }

  /// @return whether the minimum over this coordinate is reached.
  bool advance(LevySystem& system, std::span<const double> other, Unknowns& unknowns) {
    std::vector<std::array<double, 3>> rows(chart_.triangles.size(), std::array<double, 3>{});
    if (options_.orthogonality > 0) rows = orthogonality_rows(chart_, other);
    if (options_.solver == LevySolver::direct) {
      system.solve(rows, unknowns);
      return true;
    }
    return system.sweep(rows, unknowns, options_.max_sweeps, options_.tolerance) < options_.max_sweeps;
  }

  void take(const Unknowns& u, const Unknowns& v) {
    for (std::size_t i = 0; i < uv_.size(); ++i) uv_[i] = {u.value[i], v.value[i]};
  }

  double total() {
    std::vector<double> u, v;
    for (const Vec2 p : uv_) u.push_back(p.x), v.push_back(p.y);
    sums_ = {};
    const auto add = [&](const LinearRows& rows, double& sum) {
      for (std::size_t r = 0; r < rows.count(); ++r) {
        const double a = rows.value(r, u), b = rows.value(r, v);
        sum += a * a + b * b;
      }
    };
    add(smoothness_, sums_.smoothness);
    add(length_, sums_.length);
    if (is_conformal())
      sums_.orthogonality = conformal_residual(chart_, uv_);
    else
      sums_.orthogonality = orthogonal_residual(u, v);
    return options_.smoothness * sums_.smoothness + options_.orthogonality * sums_.orthogonality +
           options_.length * sums_.length;
  }

  double orthogonal_residual(const std::vector<double>& u, const std::vector<double>& v) const {
    const auto rows = orthogonality_rows(chart_, v);
    double residual = 0;
    for (std::size_t t = 0; t < rows.size(); ++t) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k) sum += rows[t][k] * u[chart_.triangles[t][k]];
      residual += sum * sum;
    }
    return residual;
  }

  const ChartSurface& chart_;
  const LevyOptions& options_;
  Held held_;
  Stopwatch clock_;
  LinearRows smoothness_, length_;
  std::vector<Vec2> uv_;
  std::vector<char> fixed_;
  bool free_scale_ = true;  ///< No values are given.
  Sums sums_;
};

}  // namespace

std::string conformal_obstacle(const LevyOptions& options, bool has_iso_lines) {
  if (options.border != LevyBorder::free) return "the border is not free from the start";
  if (options.solver != LevySolver::direct) return "the solver is Gauss-Seidel";
  if (has_iso_lines) return "iso lines are held";
  return {};
}

LevyOptions levy_as_written(LevyBorder border, LevySolver solver) {
  LevyOptions options;
  options.weights = LevyWeights::uniform;
  options.border = border;
  options.coupling = LevyCoupling::orthogonal;
  options.solver = solver;
  options.smoothness = options.orthogonality = options.length = 1;
  options.tolerance = 1e-6;
  options.max_rounds = 100;
  options.max_sweeps = 20;  // u and v take turns: neither has to be at its own minimum in between
  return options;
}

LevyResult flatten_levy(const TriangleMesh& mesh, const ChartSet& charts, const LevyOptions& options) {
  check(options, mesh.positions.size());
  LevyResult result;
  std::mutex mutex;
  std::vector<std::pair<Vec3, Sums>> of_charts;  // with the first position, for an order that is always the same
  const auto method = [&](const ChartSurface& chart) {
    const UnitChart unit = to_unit(chart);
    Held held = held_by_user(mesh, chart, unit.scale, options);
    const bool keep_place = held.by_user;
    Sums sums;
    ChartMap map = LevyMap(unit.surface, options, std::move(held)).run(sums);
    const double square_mm = 1 / (unit.scale * unit.scale);
    for (TraceSample& s : map.trace) s.error *= square_mm;
    for (Vec2& p : map.uv) p = (1 / unit.scale) * p;
    map.keep_place = keep_place;
    const std::lock_guard lock(mutex);
    of_charts.push_back({chart.positions.front(),
                         {square_mm * sums.smoothness, square_mm * sums.orthogonality, square_mm * sums.length}});
    return map;
  };
  DriverOptions driver = driver_options(k_function, options);
  driver.error_per_area = false;
  std::vector<MethodChoice> choices(charts.count);
  driver.choices = &choices;
  result.flattening = flatten_charts(mesh, charts, method, driver);
  result.choices = choices_of_charts(std::move(choices));
  std::sort(of_charts.begin(), of_charts.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [position, sums] : of_charts) {
    result.smoothness += sums.smoothness;
    result.orthogonality += sums.orthogonality;
    result.length += sums.length;
  }
  return result;
}

}  // namespace papilla
