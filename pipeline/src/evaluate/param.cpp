// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "evaluate/kinds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/meshing/cut_open.hpp"
#include "papilla/meshing/segmentation.hpp"
#include "papilla/meshing/weld.hpp"
#include "papilla/param/components.hpp"
#include "papilla/param/measure.hpp"
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

/// A variant of a method.
struct Variant {
  std::string method, solver;
  bool iterates = false;
  std::function<Flattening(const TriangleMesh&, int iterations)> run;
  bool keeps_trace = false;  ///< Draw its own error over time too.
  std::string own_error;
};

/// The chart that all methods map, as a mesh.
struct Chart {
  TriangleMesh mesh;
  ChartSet charts;
  std::string notes;
};

ChartSet one_chart(const TriangleMesh& mesh) { return {std::vector<std::uint32_t>(mesh.triangles.size(), 0), 1, 0}; }

/// The chart with the largest area, cut open.
Chart largest_chart(const TriangleMesh& mesh, const ChartSet& charts) {
  const TriangleMesh open = cut_open(mesh, charts);
  std::vector<double> area(charts.count, 0);
  for (std::size_t t = 0; t < open.triangles.size(); ++t)
    area[charts.of_triangle[t]] +=
        norm(cross(open.corner(t, 1) - open.corner(t, 0), open.corner(t, 2) - open.corner(t, 0)));
  const auto largest = static_cast<std::uint32_t>(std::max_element(area.begin(), area.end()) - area.begin());
  Chart chart;
  std::vector<Index> number(open.positions.size(), k_no_value);
  for (std::size_t t = 0; t < open.triangles.size(); ++t) {
    if (charts.of_triangle[t] != largest) continue;
    Triangle corners = open.triangles[t];
    for (Index& v : corners) {
      if (number[v] == k_no_value) {
        number[v] = static_cast<Index>(chart.mesh.positions.size());
        chart.mesh.positions.push_back(open.positions[v]);
      }
      v = number[v];
    }
    chart.mesh.triangles.push_back(corners);
    if (!open.face.empty()) chart.mesh.face.push_back(open.face[t]);
    if (!open.cad_uv.empty()) chart.mesh.cad_uv.indices.push_back(open.cad_uv.indices[t]);
  }
  chart.mesh.cad_uv.values = open.cad_uv.values;
  chart.charts = one_chart(chart.mesh);
  return chart;
}

/// The whole part if it can be mapped in one piece, else the largest of its charts.
Chart chart_of(TriangleMesh mesh) {
  mesh = weld_equal(std::move(mesh)).mesh;
  const ChartSet components = components_as_charts(mesh);
  if (components.count == 1) {
    LscmOptions strict;
    strict.fall_back = false;
    try {
      flatten_lscm(mesh, components, strict);
      return {std::move(mesh), components, "the whole part as one chart"};
    } catch (const InvalidInput&) {   // Not a disk.
    } catch (const SolverFailure&) {  // A disk, but too curved for this map.
      return {std::move(mesh), components, "the whole part as one chart"};
    }
  }
  Chart chart = largest_chart(mesh, segment_charts(mesh).charts);
  chart.notes =
      fmt::format("the largest chart, {} of {} triangles", chart.mesh.triangles.size(), mesh.triangles.size());
  return chart;
}

Variant maillot(double phi, MaillotSolver solver, const char* name) {
  const auto run = [phi, solver](const TriangleMesh& mesh, int iterations) {
    MaillotOptions options;
    options.length_weight = phi;
    options.solver = solver;
    options.max_iterations = iterations;
    options.fall_back = false;
    return flatten_maillot(mesh, one_chart(mesh), options).flattening;
  };
  return {"maillot", fmt::format("{}, phi {:g}", name, phi), true, run, true, "Maillot energy [mm²]"};
}

Variant levy(const std::string& name, const LevyOptions& options, bool iterates) {
  const auto run = [options](const TriangleMesh& mesh, int iterations) {
    LevyOptions own = options;
    own.fall_back = false;
    if (own.solver == LevySolver::gauss_seidel) own.max_sweeps = k_sweeps * iterations;
    if (own.solver == LevySolver::direct) own.max_rounds = iterations;
    return flatten_levy(mesh, one_chart(mesh), own).flattening;
  };
  return {"levy", name, iterates, run, iterates, "Lévy's sum [mm²]"};
}

Variant lscm(LscmSolver solver, const char* name) {
  return {"lscm",
          name,
          false,
          [solver](const TriangleMesh& mesh, int) {
            LscmOptions options;
            options.solver = solver;
            options.fall_back = false;
            return flatten_lscm(mesh, one_chart(mesh), options);
          },
          false,
          {}};
}

Variant reference(const char* method, ReferenceMap map, bool iterates) {
  return {method,
          "cgal",
          iterates,
          [map](const TriangleMesh& mesh, int iterations) {
            ReferenceOptions options;
            options.map = map;
            options.arap_iterations = iterations;
            options.fall_back = false;
            return flatten_reference(mesh, one_chart(mesh), options);
          },
          false,
          {}};
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
          levy("direct, orthogonal and length", alternating, true), levy("direct, smooth on a circle", convex, false),
          levy("gauss-seidel, smooth on a circle", descent, true)};
}

std::vector<Variant> variants(bool has_cad_parameters) {
  std::vector<Variant> all{reference("tutte", ReferenceMap::tutte, false),
                           reference("mvc", ReferenceMap::mean_value, false), lscm(LscmSolver::cgal, "cgal"),
                           lscm(LscmSolver::hermitian, "hermitian"), reference("arap", ReferenceMap::arap, true)};
  for (Variant& v : levy_variants()) all.push_back(std::move(v));
  for (const double phi : {0.5, 1.0}) {
    all.push_back(maillot(phi, MaillotSolver::gauss_newton, "gauss-newton"));
    all.push_back(maillot(phi, MaillotSolver::gradient_descent, "gradient-descent"));
  }
  all.push_back({"best",
                 "newton",
                 true,
                 [](const TriangleMesh& mesh, int iterations) {
                   BestOptions options;
                   options.max_iterations = iterations;
                   options.tolerance = 1e-9;
                   options.fall_back = false;
                   return flatten_best(mesh, one_chart(mesh), options);
                 },
                 false,
                 {}});
  all.push_back({"auto",
                 "",
                 false,
                 [](const TriangleMesh& mesh, int) { return flatten_automatic(mesh, one_chart(mesh)).flattening; },
                 false,
                 {}});
  all.push_back(
      {"planar", "", false, [](const TriangleMesh& mesh, int) { return flatten_planar(mesh).flattening; }, false, {}});
  all.push_back({"triplanar",
                 "",
                 false,
                 [](const TriangleMesh& mesh, int) { return flatten_triplanar(mesh).flattening; },
                 false,
                 {}});
  if (has_cad_parameters)
    all.push_back(
        {"natural", "", false, [](const TriangleMesh& mesh, int) { return flatten_natural(mesh); }, false, {}});
  for (const auto& [name, shape] : {std::pair{"sphere", IntermediateShape::sphere},
                                    {"cylinder", IntermediateShape::cylinder},
                                    {"cone", IntermediateShape::cone},
                                    {"box", IntermediateShape::box}})
    all.push_back({"intermediate",
                   name,
                   false,
                   [shape](const TriangleMesh& mesh, int) {
                     IntermediateOptions options;
                     options.shape = shape;
                     return flatten_intermediate(mesh, options).flattening;
                   },
                   false,
                   {}});
  return all;
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

/// The curves of a variant: symmetric Dirichlet, Maillot's length energy and, with keeps_trace, the method's own error.
class VariantRuns {
 public:
  VariantRuns(const Variant& variant, const Chart& chart, const std::string& input)
      : variant_(variant),
        chart_(chart),
        input_(input),
        dirichlet_{variant.method, variant.solver, input, "symmetric Dirichlet - 4", {}, {}},
        lengths_(dirichlet_) {
    lengths_.error_name = "Maillot's length energy / sum of squared edges";
  }

  /// Raises the limit of iterations while the budget allows it and the result changes.
  void run_ladder(const Budget& budget) {
    Ladder ladder(budget, k_growth);
    for (const int iterations : k_iterations)
      if (!ladder.next() || !step(iterations)) break;
    if (dirichlet_.stop.empty()) set_stop(k_time_spent, chart_.notes);
  }

  void move_to(std::vector<EvaluationRun>& runs) {
    if (variant_.keeps_trace && own_.size() > 1)
      runs.push_back(
          {variant_.method, variant_.solver, input_, variant_.own_error, own_, dirichlet_.stop, dirichlet_.notes});
    runs.push_back(std::move(dirichlet_));
    runs.push_back(std::move(lengths_));
  }

 private:
  void set_stop(const std::string& stop, const std::string& notes) {
    dirichlet_.stop = lengths_.stop = stop;
    dirichlet_.notes = lengths_.notes = notes;
  }

  /// @returns whether more iterations may change anything.
  bool step(int iterations) {
    Flattening flattening;
    const Stopwatch clock;
    try {
      flattening = variant_.run(chart_.mesh, iterations);
    } catch (const SolverFailure& error) {
      set_stop("no result", fmt::format("{} iterations: {}; {}", iterations, error.what(), chart_.notes));
      return variant_.iterates;  // More iterations may undo the flips.
    }
    const double seconds = clock.seconds();
    const DistortionReport report = measure_distortion(chart_.mesh, flattening.uv);
    const double error = report.symmetric_dirichlet.mean - 4;
    const bool same = !dirichlet_.trace.empty() && dirichlet_.trace.back().error == error;
    if (!same) {
      dirichlet_.trace.push_back({seconds, error});
      lengths_.trace.push_back({seconds, report.maillot_length});
    }
    set_stop(std::string(to_string(flattening.stop)), describe(report, flattening) + "; " + chart_.notes);
    dirichlet_.valid = lengths_.valid = is_valid(report);
    dirichlet_.shares = shares_of(report);
    if (flattening.charts.count > 1) dirichlet_.input = lengths_.input = input_ + ", in several pieces";
    own_ = flattening.trace;
    return variant_.iterates && !same;
  }

  const Variant& variant_;
  const Chart& chart_;
  std::string input_;
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
  const Chart chart = chart_of(part.mesh);
  const std::vector<Variant> all = variants(!chart.mesh.cad_uv.empty());
  const std::string name = input_name(input, part.name);
  std::vector<EvaluationRun> runs;
  for (std::size_t i = 0; i < all.size(); ++i) {
    report_progress(input.progress, "evaluate", static_cast<double>(i) / static_cast<double>(all.size()));
    VariantRuns of_variant(all[i], chart, name);
    of_variant.run_ladder(input.budget.share(all.size() - i));
    of_variant.move_to(runs);
  }
  runs.push_back(environment_run(chart.mesh, name, input.budget));
  return runs;
}

}  // namespace papilla
