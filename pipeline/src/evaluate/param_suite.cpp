// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "evaluate/extreme_meshes.hpp"
#include "evaluate/suite.hpp"
#include "papilla/meshing/mesh_bounds.hpp"
#include "papilla/meshing/weld.hpp"
#include "papilla/param/measure.hpp"
#include "papilla/pipeline/unwrap_method.hpp"

namespace papilla {
namespace {

struct Variant {
  std::string name;
  MethodOptions options;
};

/// Slow convergence on a million triangles ends with the result so far.
constexpr double k_time_limit_s = 120;

void add_levy_as_written(MethodOptions options, std::vector<Variant>& all) {
  options.levy = levy_as_written(LevyBorder::convex, LevySolver::direct);
  all.push_back({"levy, as written", options});
  options.levy = levy_as_written(LevyBorder::released, LevySolver::direct);
  all.push_back({"levy, as written, border released", options});
}

void add_maillot(MethodOptions options, std::vector<Variant>& all) {
  for (const double phi : {0.0, 0.5, 1.0}) {
    options.maillot.length_weight = phi;
    all.push_back({fmt::format("maillot, φ = {:g}", phi), options});
  }
  options.maillot = maillot_as_written(MaillotStart::conformal);
  all.push_back({"maillot, φ = 0.5, as written from conformal", options});
  options.maillot = maillot_as_written(MaillotStart::planar);
  all.push_back({"maillot, φ = 0.5, as written from planar", options});
}

std::vector<Variant> variants() {
  std::vector<Variant> all;
  for (const auto& [name, method] : unwrap_methods()) {
    MethodOptions options;
    options.method = method;
    options.charts = ChartSource::keep;
    if (method != UnwrapMethod::maillot) all.push_back({name, options});
    if (method == UnwrapMethod::levy) add_levy_as_written(options, all);
    if (method == UnwrapMethod::maillot) add_maillot(options, all);
  }
  return all;
}

void measure_map(const TriangleMesh& mesh, MethodOptions options, StabilityCell& cell) {
  PartContext context;
  context.scene_extent_mm = bounds_of(mesh).diagonal();
  if (!takes_charts(options.method)) options.charts = ChartSource::automatic;
  const FlattenedPart part = flatten_part(mesh, context, options);
  const Flattening& f = part.flattening;
  if (!f.trace.empty()) {
    cell.residual = f.trace.back().error;
    cell.iterations = static_cast<int>(f.trace.size()) - 1;
  }
  const bool finite = std::all_of(f.uv.values.begin(), f.uv.values.end(),
                                  [](Vec2 uv) { return std::isfinite(uv.x) && std::isfinite(uv.y); });
  if (!finite) {
    cell.outcome = Outcome::breaks;
    cell.note = "a texture coordinate is not finite";
    return;
  }
  if (options.method == UnwrapMethod::environment) {
    cell.note = "a preview of reflections: no map of the surface, nothing to measure";
    return;
  }
  const DistortionReport report = measure_distortion(mesh, f.uv);
  cell.error = report.symmetric_dirichlet.mean - 4;
  cell.note = fmt::format("{} charts, stop {}", f.charts.count, to_string(f.stop));
  if (report.flipped || report.degenerate_uv || report.overlap_within_charts > 0 || report.without_uv) {
    cell.outcome = Outcome::breaks;
    cell.note += fmt::format("; {} flipped, {} without area, {} unmapped, {:.2g} of the area overlaps", report.flipped,
                             report.degenerate_uv, report.without_uv, report.overlap_within_charts);
  } else if (!f.notes.empty()) {
    cell.outcome = Outcome::falls_back;
    cell.note += "; " + f.notes.front().reason;
  }
}

}  // namespace

StabilitySuite param_stability(const StabilityRun& run) {
  StabilitySuite suite{"param",
                       "Parameterization",
                       "mean symmetric Dirichlet energy − 4 (0: an isometry)",
                       "what the method minimises at its end, in its own unit",
                       {}};
  std::vector<NamedMesh> inputs = extreme_meshes();
  for (NamedMesh& input : inputs) input.mesh = weld_equal(std::move(input.mesh)).mesh;
  fill_suite(
      suite, run, inputs, variants(),
      [](const Variant& method, const NamedMesh& input, StabilityCell& cell) {
        MethodOptions options = method.options;
        options.deadline = Deadline(k_time_limit_s);
        measure_map(input.mesh, options, cell);
      },
      triangles_of);
  return suite;
}

}  // namespace papilla
