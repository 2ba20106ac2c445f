// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "evaluate/kinds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/node_places.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/meshing/cut_open.hpp"
#include "papilla/meshing/segmentation.hpp"
#include "papilla/meshing/submesh.hpp"
#include "papilla/meshing/weld.hpp"
#include "papilla/param/components.hpp"
#include "papilla/param/measure.hpp"
#include "papilla/param/pack.hpp"
#include "papilla/pipeline/unwrap_method.hpp"

namespace papilla {
namespace {

/// Limits of iterations, for methods that iterate.
constexpr std::array k_iterations = {1, 2, 5, 10, 20, 50, 100, 200, 500};

/// Gauss-Seidel sweeps per iteration of the other methods: a sweep moves one vertex at a time.
constexpr int k_sweeps = 20;

/// Expected time of a rung over that of the one before, measurement included.
constexpr double k_growth = 2.5;

/// Range of the histogram of symmetric Dirichlet - 4; two bins a decade.
constexpr double k_least_excess = 1e-8, k_most_excess = 1e8;

/// The charts that all methods map, as a mesh in which no two of them share a vertex.
struct Charts {
  TriangleMesh mesh;
  ChartSet set;
  std::string notes;
  bool may_replace = false;  ///< Several charts: one without a valid map gets another one, which is counted.
};

/// A variant of a method.
struct Variant {
  UnwrapMethod method = UnwrapMethod::automatic;
  std::string solver;
  bool iterates = false;
  std::function<Flattening(const Charts&, std::optional<int> iterations)> run;  ///< Not given: as many as by default.
  bool keeps_trace = false;                                                     ///< Draw its own error over time too.
  std::string own_error = {};
  bool has_start = false;  ///< No iterations leave the map that the method starts from: the first sample.
};

/// Charts of a mesh with vertices of their own, in the order of `numbers`.
Charts separate(const TriangleMesh& mesh, const ChartSet& charts, std::span<const std::uint32_t> numbers) {
  const TriangleMesh open = cut_open(mesh, charts);
  const std::vector<std::vector<Index>> triangles = triangles_of_charts(charts);
  Charts result;
  std::vector<Index> number(open.positions.size()), chart_of(open.positions.size(), k_no_value);
  for (const std::uint32_t c : numbers) {
    for (const Index t : triangles[c]) {
      Triangle corners = open.triangles[t];
      for (Index& v : corners) {
        if (chart_of[v] != c) {
          chart_of[v] = c;
          number[v] = static_cast<Index>(result.mesh.positions.size());
          result.mesh.positions.push_back(open.positions[v]);
        }
        v = number[v];
      }
      result.mesh.triangles.push_back(corners);
      result.set.of_triangle.push_back(result.set.count);
      if (!open.face.empty()) result.mesh.face.push_back(open.face[t]);
      if (!open.cad_uv.empty()) result.mesh.cad_uv.indices.push_back(open.cad_uv.indices[t]);
    }
    ++result.set.count;
  }
  result.mesh.cad_uv.values = open.cad_uv.values;
  return result;
}

std::uint32_t largest_chart(const TriangleMesh& mesh, const ChartSet& charts) {
  std::vector<double> area(charts.count, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    area[charts.of_triangle[t]] +=
        norm(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
  return static_cast<std::uint32_t>(std::max_element(area.begin(), area.end()) - area.begin());
}

/// The whole part if it can be mapped in one piece, else the largest of its charts.
Charts one_chart(TriangleMesh mesh) {
  const ChartSet components = components_as_charts(mesh);
  if (components.count == 1) {
    LscmOptions strict;
    strict.fall_back = false;
    const char* notes = "the whole part as one chart";
    try {
      flatten_lscm(mesh, components, strict);
      return {std::move(mesh), components, notes};
    } catch (const InvalidInput&) {   // Not a disk.
    } catch (const SolverFailure&) {  // A disk, but too curved for this map.
      return {std::move(mesh), components, notes};
    }
  }
  const ChartSet charts = segment_charts(mesh).charts;
  const std::array largest{largest_chart(mesh, charts)};
  Charts result = separate(mesh, charts, largest);
  result.notes =
      fmt::format("the largest chart, {} of {} triangles", result.mesh.triangles.size(), mesh.triangles.size());
  return result;
}

Charts charts_of(TriangleMesh mesh, ChartSource source) {
  mesh = weld_equal(std::move(mesh)).mesh;
  if (source == ChartSource::automatic) return one_chart(std::move(mesh));
  const ChartSet charts = given_charts(mesh, source);
  std::vector<std::uint32_t> all(charts.count);
  std::iota(all.begin(), all.end(), 0U);
  Charts result = separate(mesh, charts, all);
  result.may_replace = charts.count > 1;
  result.notes = fmt::format("{} charts of --charts {}", charts.count, chart_source_name(source));
  return result;
}

Variant maillot(const std::string& name, const MaillotOptions& options) {
  const auto run = [options](const Charts& charts, std::optional<int> iterations) {
    MaillotOptions own = options;
    if (iterations) own.max_iterations = *iterations;
    own.fall_back = charts.may_replace;
    return flatten_maillot(charts.mesh, charts.set, own).flattening;
  };
  return {UnwrapMethod::maillot, name, true, run, true, "Maillot energy [mm²]", true};
}

std::vector<Variant> maillot_variants() {
  std::vector<Variant> all;
  for (const double phi : {0.5, 1.0})
    for (const auto& [name, solver] : {std::pair{"gauss-newton", MaillotSolver::gauss_newton},
                                       {"gradient-descent", MaillotSolver::gradient_descent}}) {
      MaillotOptions options;
      options.length_weight = phi;
      options.solver = solver;
      all.push_back(maillot(fmt::format("{}, phi {:g}", name, phi), options));
    }
  for (const auto& [name, start] : {std::pair{"conformal", MaillotStart::conformal}, {"planar", MaillotStart::planar}})
    all.push_back(maillot(fmt::format("as written from {}", name), maillot_as_written(start)));
  return all;
}

Variant levy(const std::string& name, const LevyOptions& options, bool iterates) {
  const auto run = [options](const Charts& charts, std::optional<int> iterations) {
    LevyOptions own = options;
    own.fall_back = charts.may_replace;
    // Without the coupling all sweeps are of one round.
    if (iterations && own.orthogonality == 0) own.max_sweeps = k_sweeps * *iterations;
    if (iterations && own.orthogonality > 0) own.max_rounds = *iterations;
    return flatten_levy(charts.mesh, charts.set, own).flattening;
  };
  return {UnwrapMethod::levy, name, iterates, run, iterates, "Lévy's sum [mm²]"};
}

Variant lscm(LscmSolver solver, const char* name) {
  const auto run = [solver](const Charts& charts, std::optional<int>) {
    LscmOptions options;
    options.solver = solver;
    options.fall_back = charts.may_replace;
    return flatten_lscm(charts.mesh, charts.set, options);
  };
  return {UnwrapMethod::lscm, name, false, run};
}

Variant reference(UnwrapMethod method, ReferenceMap map, bool iterates) {
  const auto run = [map](const Charts& charts, std::optional<int> iterations) {
    ReferenceOptions options;
    options.map = map;
    if (iterations) options.arap_iterations = *iterations;
    options.fall_back = charts.may_replace;
    return flatten_reference(charts.mesh, charts.set, options);
  };
  return {method, "cgal", iterates, run};
}

std::vector<Variant> levy_variants() {
  LevyOptions conformal, alternating, convex, descent;
  alternating.coupling = LevyCoupling::orthogonal;
  convex.border = descent.border = LevyBorder::convex;
  convex.orthogonality = descent.orthogonality = convex.length = descent.length = 0;
  convex.smoothness = descent.smoothness = 1;
  descent.solver = LevySolver::gauss_seidel;
  descent.tolerance = 1e-9;
  return {levy("direct, conformal and length", conformal, false),
          levy("direct, orthogonal and length", alternating, true),
          levy("direct, smooth on a circle", convex, false),
          levy("gauss-seidel, smooth on a circle", descent, true),
          levy("direct, as written", levy_as_written(LevyBorder::convex, LevySolver::direct), true),
          levy("gauss-seidel, as written", levy_as_written(LevyBorder::convex), true),
          levy("direct, as written, border released", levy_as_written(LevyBorder::released, LevySolver::direct), true),
          levy("gauss-seidel, as written, border released", levy_as_written(LevyBorder::released), true)};
}

Variant best() {
  const auto run = [](const Charts& charts, std::optional<int> iterations) {
    BestOptions options;
    if (iterations) {
      options.max_iterations = *iterations;
      options.tolerance = 1e-9;
    }
    options.fall_back = charts.may_replace;
    return flatten_best(charts.mesh, charts.set, options);
  };
  return {UnwrapMethod::best, "newton", true, run};
}

/// Methods that find their charts in the mesh: connected pieces, or parts of them.
std::vector<Variant> projections(bool has_cad_parameters) {
  std::vector<Variant> all{
      {UnwrapMethod::planar, "", false,
       [](const Charts& charts, std::optional<int>) { return flatten_planar(charts.mesh).flattening; }},
      {UnwrapMethod::triplanar, "", false,
       [](const Charts& charts, std::optional<int>) { return flatten_triplanar(charts.mesh).flattening; }}};
  if (has_cad_parameters)
    all.push_back({UnwrapMethod::natural, "", false,
                   [](const Charts& charts, std::optional<int>) { return flatten_natural(charts.mesh); }});
  for (const auto& [name, shape] : {std::pair{"sphere", IntermediateShape::sphere},
                                    {"cylinder", IntermediateShape::cylinder},
                                    {"cone", IntermediateShape::cone},
                                    {"box", IntermediateShape::box}})
    all.push_back({UnwrapMethod::intermediate, name, false, [shape](const Charts& charts, std::optional<int>) {
                     IntermediateOptions options;
                     options.shape = shape;
                     return flatten_intermediate(charts.mesh, options).flattening;
                   }});
  return all;
}

std::vector<Variant> variants(bool has_cad_parameters) {
  std::vector<Variant> all{reference(UnwrapMethod::tutte, ReferenceMap::tutte, false),
                           reference(UnwrapMethod::mvc, ReferenceMap::mean_value, false),
                           lscm(LscmSolver::cgal, "cgal"), lscm(LscmSolver::hermitian, "hermitian"),
                           reference(UnwrapMethod::arap, ReferenceMap::arap, true)};
  for (Variant& v : levy_variants()) all.push_back(std::move(v));
  for (Variant& v : maillot_variants()) all.push_back(std::move(v));
  all.push_back(best());
  all.push_back({UnwrapMethod::automatic, "", false, [](const Charts& charts, std::optional<int>) {
                   return flatten_automatic(charts.mesh, charts.set).flattening;
                 }});
  for (Variant& v : projections(has_cad_parameters)) all.push_back(std::move(v));
  return all;
}

/// Many cheap steps, or as CGAL does them.
bool is_slow(const Variant& v) {
  return v.method == UnwrapMethod::arap || v.solver.starts_with("gauss-seidel") ||
         v.solver.starts_with("gradient-descent") || v.solver.starts_with("as written");
}

bool is_valid(const DistortionReport& r) {
  return r.flipped == 0 && r.degenerate_uv == 0 && r.overlap_within_charts <= 0;
}

/// Histogram of symmetric Dirichlet - 4 by area.
ErrorShares shares_of(const DistortionReport& report) {
  ErrorShares shares{"symmetric Dirichlet - 4", {}, {}};
  for (double edge = k_least_excess; edge <= 1.01 * k_most_excess; edge *= std::sqrt(10.0))
    shares.edges.push_back(edge);
  shares.shares.assign(shares.edges.size() - 1, 0);
  double area = 0;
  for (const TriangleDistortion& t : report.per_triangle) {
    if (!t.measured) continue;
    const double bin = 2 * std::log10(std::max(t.symmetric_dirichlet - 4, k_least_excess) / k_least_excess);
    shares.shares[std::min(static_cast<std::size_t>(bin), shares.shares.size() - 1)] += t.area_mm2;
    area += t.area_mm2;
  }
  for (double& share : shares.shares) share /= area > 0 ? area : 1;
  return shares;
}

std::string describe(const DistortionReport& r, const Flattening& f) {
  std::string text = fmt::format("SD {:.6g} (max {:.3g}), Maillot {:.4g}, stretch L2 {:.5g}, angle {:.3g}°, {} charts",
                                 r.symmetric_dirichlet.mean, r.symmetric_dirichlet.max, r.maillot_length, r.stretch_l2,
                                 r.angle_error_deg.mean, f.charts.count);
  if (!is_valid(r))
    text += fmt::format("; NOT VALID: {} flipped, {} without area, {:.2g} overlapping", r.flipped, r.degenerate_uv,
                        r.overlap_within_charts);
  return text;
}

/// The curves of a variant: symmetric Dirichlet, Maillot's length energy and, with keeps_trace, the method's own error;
/// and what it makes at its default options.
class VariantRuns {
 public:
  VariantRuns(const Variant& variant, const Charts& charts, const EvaluationInput& input, const std::string& name)
      : variant_(variant),
        charts_(charts),
        name_(name),
        measure_{.normalize = input.param.normalize},
        dirichlet_{unwrap_method_name(variant.method), variant.solver, name, "symmetric Dirichlet - 4", {}, {}},
        lengths_(dirichlet_) {
    lengths_.error_name = "Maillot's length energy / sum of squared edges";
    dirichlet_.map.emplace();
    dirichlet_.map->input = name;
    dirichlet_.map->triangles = charts.mesh.triangles.size();
    dirichlet_.map->given_charts = charts.set.count;
    dirichlet_.map->failure = k_time_spent;
    set_stop(k_time_spent, charts.notes);
  }

  /// The row of the table; where iterations change nothing, the curve is this one sample.
  void run_at_defaults(const Budget& budget) {
    if (budget.spent()) return;
    const Sample sample = sample_with(std::nullopt);
    EvaluatedMap& map = *dirichlet_.map;
    map.failure = sample.failure;
    if (sample.flattening) {
      map.charts = sample.flattening->charts.count;
      map.valid = is_valid(sample.report);
      map.replaced = sample.flattening->notes.size();
      map.distortion = sample.report;
      map.distortion.per_triangle.clear();
    }
    if (!variant_.iterates) add(sample, "by default");
  }

  /// Raises the limit of iterations while the budget allows it and the result changes.
  void run_ladder(const Budget& budget) {
    if (!variant_.iterates) return;
    Ladder ladder(budget, k_growth);
    if (variant_.has_start && (!ladder.next() || !add(sample_with(0), "0 iterations"))) return;
    for (const int iterations : k_iterations)
      if (!ladder.next() || !add(sample_with(iterations), fmt::format("{} iterations", iterations))) break;
  }

  void move_to(std::vector<EvaluationRun>& runs) {
    if (variant_.keeps_trace && own_.size() > 1)
      runs.push_back({dirichlet_.method, variant_.solver, dirichlet_.input, variant_.own_error, own_, dirichlet_.stop,
                      dirichlet_.notes});
    runs.push_back(std::move(dirichlet_));
    runs.push_back(std::move(lengths_));
  }

 private:
  struct Sample {
    double seconds = 0;
    std::optional<Flattening> flattening;
    DistortionReport report;
    std::string failure;
  };

  void set_stop(const std::string& stop, const std::string& notes) {
    dirichlet_.stop = lengths_.stop = stop;
    dirichlet_.notes = lengths_.notes = notes;
  }

  Sample sample_with(std::optional<int> iterations) const {
    Sample sample;
    const Stopwatch clock;
    try {
      sample.flattening = variant_.run(charts_, iterations);
    } catch (const SolverFailure& error) {
      sample.failure = error.what();
      return sample;
    }
    sample.seconds = clock.seconds();
    CornerAttribute<Vec2> uv = sample.flattening->uv;
    // Charts that the methods left on top of each other must not be taken for one.
    if (sample.flattening->charts.count > 1) uv = pack_atlas(uv, sample.flattening->charts).uv;
    sample.report = measure_distortion(charts_.mesh, uv, measure_);
    return sample;
  }

  /// @returns whether more iterations may change anything.
  bool add(const Sample& sample, const std::string& limit) {
    if (!sample.flattening) {
      set_stop("no result", limit + ": " + sample.failure + "; " + charts_.notes);
      return true;  // More iterations may undo the flips.
    }
    const Flattening& flattening = *sample.flattening;
    const DistortionReport& report = sample.report;
    const double error = report.symmetric_dirichlet.mean - 4;
    const bool same = !dirichlet_.trace.empty() && dirichlet_.trace.back().error == error;
    if (!same) {
      dirichlet_.trace.push_back({sample.seconds, error});
      lengths_.trace.push_back({sample.seconds, report.maillot_length});
    }
    set_stop(std::string(to_string(flattening.stop)),
             describe(report, flattening) + descent_of(flattening.trace) + "; " + charts_.notes);
    dirichlet_.valid = lengths_.valid = is_valid(report);
    dirichlet_.shares = shares_of(report);
    if (flattening.charts.count > charts_.set.count) dirichlet_.input = lengths_.input = name_ + ", in several pieces";
    own_ = flattening.trace;
    return !same;
  }

  /// How much of the method's own error its start has, and how much the end.
  std::string descent_of(const Trace& trace) const {
    if (!variant_.keeps_trace || trace.size() < 2) return {};
    return fmt::format("; {}: {:.5g} at the start, {:.5g} at the end", variant_.own_error, trace.front().error,
                       trace.back().error);
  }

  const Variant& variant_;
  const Charts& charts_;
  std::string name_;
  MeasureOptions measure_;
  EvaluationRun dirichlet_, lengths_;
  Trace own_;
};

}  // namespace

std::vector<EvaluationRun> evaluate_param(const EvaluationInput& input) {
  const Scene scene = read_scene(input.file, input.read, input.progress);
  const std::vector<std::uint32_t> largest = largest_parts(scene, 1);
  if (largest.empty() || scene.parts[largest.front()].mesh.triangles.empty())
    throw InvalidInput(input.file + ": no part has triangles to map");
  const Part& part = scene.parts[largest.front()];
  Charts charts;
  try {
    charts = charts_of(part.mesh, input.param.charts);
  } catch (const InvalidInput& error) {
    throw InvalidInput(input.file + ": part '" + shown_name(part) + "': " + error.what());
  }
  std::vector<Variant> all = variants(!charts.mesh.cad_uv.empty());
  std::erase_if(all, [&](const Variant& v) { return !input.param.has(v.method); });
  const std::string name = input_name(input, part.name);
  std::vector<VariantRuns> of_variants;
  of_variants.reserve(all.size());
  for (const Variant& variant : all) of_variants.emplace_back(variant, charts, input, name);
  double done = 0;
  const auto progress = [&] {
    report_progress(input.progress, "evaluate",
                    done++ / (2 * static_cast<double>(std::max(all.size(), std::size_t{1}))));
  };
  // Those that take longest come last: when the time is spent, rows of others are there.
  for (const bool slow : {false, true})
    for (std::size_t i = 0; i < all.size(); ++i)
      if (is_slow(all[i]) == slow) progress(), of_variants[i].run_at_defaults(input.budget);
  std::vector<EvaluationRun> runs;
  for (std::size_t i = 0; i < all.size(); ++i) {
    progress();
    of_variants[i].run_ladder(input.budget.share(all.size() - i));
    of_variants[i].move_to(runs);
  }
  if (input.param.has(UnwrapMethod::environment) && input.param.charts == ChartSource::automatic)
    for (const auto& [map, value] : environment_maps())
      runs.push_back(environment_run(charts.mesh, value, map, name, input.budget));
  return runs;
}

}  // namespace papilla
