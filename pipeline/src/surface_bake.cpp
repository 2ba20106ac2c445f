// SPDX-License-Identifier: MIT
#include "surface_bake.hpp"

#include <fmt/core.h>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "papilla/cache/stage_cache.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/core/units.hpp"
#include "papilla/meshing/mesh_assembly.hpp"
#include "papilla/meshing/weld.hpp"
#include "papilla/param/measure.hpp"

namespace papilla {
namespace {

/// uv in millimetres -> repeats of the grain, moved by its phase. Whole repeats are taken off chart by chart, so that
/// float coordinates keep their precision.
CornerAttribute<Vec2> repeats_of(const Flattening& flattening, const std::array<double, 2>& size_mm, Vec2 phase_mm) {
  CornerAttribute<Vec2> uv = flattening.uv;
  for (Vec2& value : uv.values) value = {(value.x - phase_mm.x) / size_mm[0], (value.y - phase_mm.y) / size_mm[1]};
  std::vector<Bounds2> bounds(flattening.charts.count);
  std::vector<std::uint32_t> chart_of_value(uv.values.size(), 0);
  for (std::size_t t = 0; t < uv.indices.size(); ++t) {
    const std::uint32_t chart = flattening.charts.of_triangle[t];
    for (const Index i : uv.indices[t]) {
      chart_of_value[i] = chart;
      bounds[chart].add(uv.values[i]);
    }
  }
  for (std::size_t i = 0; i < uv.values.size(); ++i) {
    const Vec2 low = bounds[chart_of_value[i]].low, whole{std::floor(low.x), std::floor(low.y)};
    uv.values[i] = uv.values[i] - whole;
  }
  return uv;
}

CornerAttribute<Vec2> scaled(CornerAttribute<Vec2> uv, double factor) {
  for (Vec2& value : uv.values) value = factor * value;
  return uv;
}

/// What single precision adds to a number.
double rounding(double x) { return static_cast<double>(static_cast<float>(x)) - x; }

/// Moves what is measured, uv in millimetres, by what a GLB's rounding does to what is written: positions in metres,
/// repeats of the grain with v downwards.
void round_as_written(TriangleMesh& measured, const CornerAttribute<Vec2>& repeats,
                      const std::array<double, 2>& size_mm) {
  for (Vec3& p : measured.positions)
    p = p + (1 / k_metres_per_mm) *
                Vec3{rounding(k_metres_per_mm * p.x), rounding(k_metres_per_mm * p.y), rounding(k_metres_per_mm * p.z)};
  for (std::size_t i = 0; i < repeats.values.size(); ++i) {
    const Vec2 repeat = repeats.values[i];
    measured.uv.values[i] =
        measured.uv.values[i] + Vec2{size_mm[0] * rounding(repeat.x), -size_mm[1] * rounding(1 - repeat.y)};
  }
}

/// How many charts each method got.
std::string charts_by_method(const std::vector<ChartChoice>& choices) {
  std::map<std::string, std::size_t> count;
  for (const ChartChoice& choice : choices) ++count[choice.method];
  std::string text;
  for (const auto& [method, charts] : count)
    text += fmt::format("{}{} {}", text.empty() ? "charts: " : ", ", charts, method);
  return text;
}

/// The seams of uv that stay, in millimetres: their mesh need not be welded, nor have uv everywhere.
SeamVisibility kept_seams(const TriangleMesh& mesh, const UnwrapOptions& options) {
  std::vector<Index> with_uv;
  for (Index t = 0; t < mesh.triangles.size(); ++t)
    if (mesh.uv.has_value(t)) with_uv.push_back(t);
  const TriangleMesh welded = weld_equal(extract_triangles(mesh, with_uv)).mesh;
  return seam_visibility(welded, welded.uv, {.tile_mm = options.tile_mm, .grain_mm = grain_size(options)});
}

/// Gives the surface new uv.
void unwrap_surface(SurfaceInput& input, SurfaceOutput& output) {
  UnwrappedPart part = unwrap_part(input.mesh, input.context, input.options);
  output.repair_seconds = part.repair_seconds;
  output.charts_seconds = part.segment_seconds;
  output.unwrap_seconds = part.solve_seconds;
  BakedSurface& report = output.report;
  report.repaired = std::move(part.repaired);
  report.method = part.method;
  const bool is_automatic = input.options.method.method == UnwrapMethod::automatic;
  report.reason = !part.reason.empty()     ? part.reason
                  : input.unwrap == "levy" ? "as the material says, " + charts_by_method(part.choices)
                  : !is_automatic          ? "as the material says"
                                           : charts_by_method(part.choices);
  report.stop = part.flattening.stop;
  report.charts = part.flattening.charts.count;
  report.seam_mm = part.flattening.charts.seam_length_mm;
  report.grain_continued_mm = part.grain_continued_mm;
  report.seams = part.seams;
  for (const ChartNote& note : part.flattening.notes) report.notes.push_back(note.reason);
  output.mesh = std::move(input.mesh);
  output.mesh.uv = repeats_of(part.flattening, input.size_mm, input.phase_mm);
  report.mesh = output.mesh;
  report.mesh.uv = std::move(part.flattening.uv);
  round_as_written(report.mesh, output.mesh.uv, input.size_mm);
}

/// Leaves the surface its own uv.
void keep_uv(SurfaceInput& input, SurfaceOutput& output) {
  BakedSurface& report = output.report;
  report.method = "kept";
  report.reason = input.uv_note;
  output.mesh = std::move(input.mesh);
  report.mesh = output.mesh;
  report.mesh.uv = scaled(output.mesh.uv, input.uv_mm_per_unit);
  const UnwrapOptions& options = input.options;
  const auto make = [&] { return kept_seams(report.mesh, options); };
  report.seams = remembered(options.method.cache, "seams", CacheUse::read_write, make, report.mesh, options.tile_mm,
                            grain_size(options))
                     .value;
  report.seam_mm = report.seams.seam_mm;
}

}  // namespace

TriangleMesh surface_mesh(const Scene& scene, const PartSurface& surface) {
  const TriangleMesh& mesh = scene.parts[surface.part].mesh;
  return surface.triangles.size() == mesh.triangles.size() ? mesh : extract_triangles(mesh, surface.triangles);
}

SurfaceInput surface_input(const PartSurface& surface, const MaterialRule& rule, TriangleMesh mesh, const Grain& grain,
                           PartContext context, UnwrapOptions options) {
  SurfaceInput input;
  input.label = surface.label;
  input.unwrap = rule.unwrap;
  input.mesh = std::move(mesh);
  input.unwraps = decision(surface.plan, Stage::unwrap).run;
  input.uv_mm_per_unit = surface.uv_mm_per_unit;
  input.uv_note = surface.uv_note;
  input.size_mm = {grain.size_mm[0], grain.size_mm[1]};
  input.phase_mm = rule.phase_mm;
  context.part = surface.label;
  context.tile_mm = options.tile_mm = {grain.size_mm[0], grain.size_mm[1]};
  if (rule.unwrap_options) {
    const MethodOptions common = std::exchange(options.method, *rule.unwrap_options);
    options.method.effort = common.effort;
    options.method.deadline = common.deadline;
    options.method.progress = common.progress;
    options.method.cache = common.cache;
  }
  // "keep" gets here where there is nothing to keep.
  const bool is_method = unwrap_methods().contains(rule.unwrap);
  options.method.method = unwrap_methods().at(is_method ? rule.unwrap : "auto");
  options.layout = UvLayout::tile;
  options.repair = decision(surface.plan, Stage::repair).run;
  input.context = std::move(context);
  input.options = std::move(options);
  return input;
}

SurfaceOutput bake_surface(SurfaceInput input) try {
  SurfaceOutput output;
  if (input.unwraps)
    unwrap_surface(input, output);
  else
    keep_uv(input, output);
  const Stopwatch clock;
  const MethodOptions& method = input.options.method;
  MeasureOptions options;
  options.overlap = !method.deadline.passed();
  const TriangleMesh& mesh = output.report.mesh;
  const auto make = [&] { return measure_distortion(mesh, mesh.uv, options); };
  output.report.distortion = remembered(method.cache, "measure", use_until(method.deadline), make, mesh.positions,
                                        mesh.triangles, mesh.uv, options)
                                 .value;
  output.measure_seconds = clock.seconds();
  return output;
} catch (const SolverFailure& error) {
  throw SolverFailure("part '" + input.label + "': " + error.what());
} catch (const InvalidInput& error) {
  throw InvalidInput("part '" + input.label + "': " + error.what());
}

}  // namespace papilla
