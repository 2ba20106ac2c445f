// SPDX-License-Identifier: MIT
#include "papilla/pipeline/unwrap_method.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "papilla/core/error.hpp"
#include "papilla/meshing/chart_cuts.hpp"
#include "papilla/meshing/mesh_bounds.hpp"
#include "papilla/meshing/uv_charts.hpp"
#include "papilla/param/components.hpp"
#include "papilla/param/edge_loop.hpp"
#include "papilla/param/grain_direction.hpp"
#include "papilla/param/grain_frame.hpp"
#include "papilla/param/seam_choice.hpp"
#include "part_charts.hpp"
#include "part_within_bound.hpp"

namespace papilla {
namespace {

using namespace detail;

/// Triangles of a part up to which several seam costs are tried: two or three times the time is no matter there.
std::size_t most_for_seam_choice(UnwrapEffort effort) {
  switch (effort) {
    case UnwrapEffort::fast: return 0;
    case UnwrapEffort::normal: return 50'000;
    case UnwrapEffort::best: break;
  }
  return std::numeric_limits<std::size_t>::max();
}

void set_effort(MethodOptions& o) {
  if (o.effort == UnwrapEffort::fast) {
    o.segmentation.union_trials *= 0.15;
    o.best.newton_vertices = 20'000;
    o.best.tolerance = 1e-2;
  }
  if (o.effort == UnwrapEffort::best) {
    o.best.newton_vertices = std::numeric_limits<std::size_t>::max();
    o.best.tolerance = 1e-5;
    o.best.max_iterations = 500;
  }
}

/// Gives every method what they all share.
MethodOptions prepare(const TriangleMesh& mesh, const MethodOptions& given, const PartContext& context) {
  MethodOptions o = given;
  const UpAxis up = context.up;
  o.grains = {grain_of(given.grains, context.part)};
  if (o.grains.front().source == GrainSource::longest) o.grains.front().vector = longest_direction(mesh);
  o.triplanar.up = up;
  o.triplanar.tile_mm = context.tile_mm;
  o.planar.up = o.intermediate.up = o.environment.up = up;
  const bool fall_back = o.charts != ChartSource::keep;
  const auto share = [&](auto& method) {
    method.up = up;
    method.fall_back = fall_back;
    method.projection = o.triplanar;
  };
  share(o.natural), share(o.maillot), share(o.levy), share(o.lscm), share(o.reference), share(o.best);
  o.natural.fall_back = true;
  if (o.charts == ChartSource::automatic) o.best.energy_limit = 4 + worth_halving(o.segmentation);
  set_effort(o);
  if (o.iterations) o.maillot.max_iterations = o.best.max_iterations = *o.iterations;
  if (o.iterations) o.levy.length_rounds = *o.iterations;
  if (o.iterations) o.levy.max_rounds = o.reference.arap_iterations = std::max(*o.iterations, 1);
  if (o.tolerance)
    o.maillot.tolerance = o.best.tolerance = o.levy.tolerance = o.reference.arap_tolerance = *o.tolerance;
  o.maillot.deadline = o.best.deadline = o.levy.deadline = o.lscm.deadline = o.reference.deadline = o.deadline;
  o.best.progress = progress_within(o.progress, k_share_of_charts, 1);
  for (const PlacedPin& pin : o.pins)
    if (is_for_part(pin.part, context.part)) o.levy.pins.push_back(pin_on(mesh, pin));
  for (const PlacedIsoLine& line : o.iso_lines)
    if (is_for_part(line.part, context.part)) o.levy.iso_lines.push_back(iso_line_on(mesh, line));
  o.automatic.up = up;
  o.automatic.best = o.best;
  o.reference.map = o.method == UnwrapMethod::tutte ? ReferenceMap::tutte
                    : o.method == UnwrapMethod::mvc ? ReferenceMap::mean_value
                                                    : ReferenceMap::arap;
  return o;
}

/// As choose_seam_cost() does.
Flattening chart_at_best_price(const TriangleMesh& mesh, const MethodOptions& o, const PartContext& context,
                               PartMemory& memory, FlattenedPart& part) {
  std::vector<std::vector<ChartChoice>> choices;
  SeamChoice choice = choose_seam_cost(mesh, [&](double seam_cost) {
    MethodOptions own = o;
    own.segmentation.seam_cost = seam_cost;
    own.best.energy_limit = own.automatic.best.energy_limit = 4 + worth_halving(own.segmentation);
    Flattening flattening = chart_and_map(mesh, own, context, memory, part);
    choices.push_back(std::move(part.choices));
    return flattening;
  });
  part.choices = std::move(choices[choice.chosen]);
  return std::move(choice.flattening);
}

Flattening flatten(const TriangleMesh& mesh, const MethodOptions& o, const PartContext& context, FlattenedPart& part) {
  switch (o.method) {
    case UnwrapMethod::natural: return flatten_natural(mesh, o.natural);
    case UnwrapMethod::intermediate: return flatten_intermediate(mesh, o.intermediate).flattening;
    case UnwrapMethod::planar: return flatten_planar(mesh, o.planar).flattening;
    case UnwrapMethod::triplanar: return flatten_triplanar(mesh, o.triplanar).flattening;
    case UnwrapMethod::environment: {
      Flattening f;
      f.uv = environment_uv(mesh, o.environment);
      f.charts = components_as_charts(mesh);
      return f;
    }
    default: break;
  }
  PartMemory memory;
  if (o.charts != ChartSource::automatic)
    return map_or_halve(mesh, given_charts(mesh, o.charts), o, 0, memory, part.choices);
  if (o.max_distortion) return chart_within_bound(mesh, o, context, part);
  if (o.choose_seam_cost && mesh.triangles.size() <= most_for_seam_choice(o.effort))
    return chart_at_best_price(mesh, o, context, memory, part);
  return chart_and_map(mesh, o, context, memory, part);
}

}  // namespace

std::string reason_to_project(const PartContext& context) {
  // Parts are small below this fraction of the scene, many from this number on, and grain is fine when it repeats so
  // many times over the part.
  constexpr double k_small = 0.05, k_fine = 20;
  constexpr std::size_t k_many = 50;
  const double tile = std::max(context.tile_mm.x, context.tile_mm.y), extent_mm = context.extent_mm;
  if (!(tile > 0)) return {};
  if (extent_mm < tile) return fmt::format("its extent of {:.3g} mm is less than one repeat of the grain", extent_mm);
  if (context.parts >= k_many && extent_mm < k_small * context.scene_extent_mm && extent_mm > k_fine * tile)
    return fmt::format(
        "it is one of {} parts, {:.2g} of the scene's extent, and the grain repeats {:.0f} times over it",
        context.parts, extent_mm / context.scene_extent_mm, extent_mm / tile);
  return {};
}

ChartSet given_charts(const TriangleMesh& mesh, ChartSource source) {
  if (source == ChartSource::uv) return open_closed_charts(mesh, uv_charts(mesh));
  require_manifold(mesh);
  return open_closed_charts(mesh, components_as_charts(mesh));
}

bool takes_charts(UnwrapMethod method) {
  switch (method) {
    case UnwrapMethod::natural:
    case UnwrapMethod::intermediate:
    case UnwrapMethod::planar:
    case UnwrapMethod::environment:
    case UnwrapMethod::triplanar: return false;
    default: return true;
  }
}

namespace {

void turn_part(const TriangleMesh& mesh, const PlacedGrain& grain, Flattening& flattening) {
  switch (grain.source) {
    case GrainSource::up: break;  // as the methods leave it
    case GrainSource::longest:
    case GrainSource::direction: flattening.uv = turn_to_grain(mesh, flattening, grain.vector); break;
    case GrainSource::edge_loop:
      flattening.uv = turn_to_grain(mesh, flattening, edge_loop_near(mesh, grain.vector));
      break;
  }
}

/// Planar projections, which take next to no time.
void project_for_want_of_time(const TriangleMesh& mesh, MethodOptions& o, FlattenedPart& part) {
  o.method = UnwrapMethod::triplanar;
  part.reason = "the time limit left no time for another";
  part.choices.clear();
  part.flattening = flatten_triplanar(mesh, o.triplanar).flattening;
  part.flattening.stop = StopReason::time_limit;
}

}  // namespace

FlattenedPart flatten_part(const TriangleMesh& mesh, const PartContext& given, const MethodOptions& options) {
  PartContext context = given;
  if (!(context.extent_mm > 0)) context.extent_mm = bounds_of(mesh).diagonal();
  MethodOptions o = prepare(mesh, options, context);
  FlattenedPart part;
  if (o.max_distortion && o.charts != ChartSource::automatic)
    throw InvalidInput("max_distortion: it finds charts, which are given");
  if (const std::string reason = foreign_option("max_distortion", o.method); o.max_distortion && !reason.empty())
    throw InvalidInput("max_distortion: it " + reason);
  if (o.method == UnwrapMethod::automatic && o.charts == ChartSource::automatic) {
    part.reason = reason_to_project(context);
    if (!part.reason.empty()) o.method = UnwrapMethod::triplanar;
  }
  const bool may_project = takes_charts(o.method) && o.charts != ChartSource::keep;
  if (may_project && o.deadline.passed()) {
    project_for_want_of_time(mesh, o, part);
  } else {
    try {
      part.flattening = flatten(mesh, o, context, part);
    } catch (const Cancelled&) {  // Only a segmentation whose time is up ends so.
      project_for_want_of_time(mesh, o, part);
    }
  }
  part.method = unwrap_method_name(o.method);
  if (o.method != UnwrapMethod::environment) turn_part(mesh, o.grains.front(), part.flattening);
  return part;
}

}  // namespace papilla
