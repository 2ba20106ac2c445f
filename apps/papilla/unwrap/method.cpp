// SPDX-License-Identifier: GPL-3.0-or-later
#include "unwrap/method.hpp"

#include <algorithm>

#include "papilla/meshing/chart_cuts.hpp"
#include "papilla/meshing/cut_open.hpp"
#include "papilla/param/components.hpp"
#include "papilla/param/grain_frame.hpp"

namespace papilla::app {
namespace {

/// Gives every method what they all share.
MethodOptions prepare(const MethodOptions& given, GrainUp up, Vec2 tile_mm) {
  MethodOptions o = given;
  o.triplanar.up = up;
  o.triplanar.tile_mm = tile_mm;
  o.planar.up = o.intermediate.up = o.environment.up = up;
  const bool fall_back = o.charts != ChartSource::keep;
  const auto share = [&](auto& method) {
    method.up = up;
    method.fall_back = fall_back;
    method.projection = o.triplanar;
  };
  share(o.natural), share(o.maillot), share(o.levy), share(o.lscm), share(o.reference), share(o.best);
  o.natural.fall_back = true;
  if (o.iterations) o.maillot.max_iterations = o.best.max_iterations = *o.iterations;
  if (o.iterations) o.levy.max_rounds = o.reference.arap_iterations = std::max(*o.iterations, 1);
  if (o.tolerance)
    o.maillot.tolerance = o.best.tolerance = o.levy.tolerance = o.reference.arap_tolerance = *o.tolerance;
  if (o.time_limit_s) o.maillot.time_limit_s = o.best.time_limit_s = o.levy.time_limit_s = *o.time_limit_s;
  o.reference.map = o.method == UnwrapMethod::tutte ? ReferenceMap::tutte
                    : o.method == UnwrapMethod::mvc ? ReferenceMap::mean_value
                                                    : ReferenceMap::arap;
  return o;
}

Flattening map_charts(const TriangleMesh& mesh, const ChartSet& charts, const MethodOptions& o) {
  switch (o.method) {
    case UnwrapMethod::maillot: return flatten_maillot(mesh, charts, o.maillot).flattening;
    case UnwrapMethod::levy: return flatten_levy(mesh, charts, o.levy).flattening;
    case UnwrapMethod::lscm: return flatten_lscm(mesh, charts, o.lscm);
    case UnwrapMethod::best: return flatten_best(mesh, charts, o.best);
    default: return flatten_reference(mesh, charts, o.reference);
  }
}

/// Maps with a border on a circle need disks; the others leave holes of flat sheets as they are. Grain of known size
/// wants its direction kept.
SegmentationOptions segmentation_of(const MethodOptions& o, GrainUp up, Vec2 tile_mm) {
  SegmentationOptions segmentation = o.segmentation;
  const bool on_circle = o.method == UnwrapMethod::tutte || o.method == UnwrapMethod::mvc ||
                         (o.method == UnwrapMethod::levy && o.levy.border == LevyBorder::convex);
  segmentation.disks = on_circle;
  if (tile_mm.x > 0 && tile_mm.y > 0)
    segmentation.grain = [up](Vec3 normal) { return grain_direction(normal, up); };
  return segmentation;
}

/// Halves charts that have no valid map, a few times, before another map takes their place.
Flattening map_or_halve(const TriangleMesh& mesh, ChartSet charts, const MethodOptions& options) {
  constexpr int k_max_halvings = 6;
  for (int i = 0;; ++i) {
    Flattening flattening = map_charts(cut_open(mesh, charts), charts, options);
    if (flattening.notes.empty() || i == k_max_halvings) {
      keep_cuts(mesh, charts.cuts, flattening.charts);
      return flattening;
    }
    std::vector<std::uint32_t> failed;
    for (const ChartNote& note : flattening.notes) failed.push_back(note.chart);
    charts = halve_charts(mesh, charts, failed);
  }
}

}  // namespace

const std::map<std::string, UnwrapMethod>& unwrap_methods() {
  static const std::map<std::string, UnwrapMethod> names{{"natural", UnwrapMethod::natural},
                                                         {"intermediate", UnwrapMethod::intermediate},
                                                         {"planar", UnwrapMethod::planar},
                                                         {"environment", UnwrapMethod::environment},
                                                         {"triplanar", UnwrapMethod::triplanar},
                                                         {"maillot", UnwrapMethod::maillot},
                                                         {"levy", UnwrapMethod::levy},
                                                         {"tutte", UnwrapMethod::tutte},
                                                         {"mvc", UnwrapMethod::mvc},
                                                         {"lscm", UnwrapMethod::lscm},
                                                         {"arap", UnwrapMethod::arap},
                                                         {"best", UnwrapMethod::best}};
  return names;
}

std::string unwrap_method_name(UnwrapMethod method) {
  const auto& names = unwrap_methods();
  return std::find_if(names.begin(), names.end(), [&](const auto& n) { return n.second == method; })->first;
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

Flattening flatten_part(const TriangleMesh& mesh, GrainUp up, Vec2 tile_mm, const MethodOptions& options,
                        double& segment_seconds) {
  const MethodOptions o = prepare(options, up, tile_mm);
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
  const Stopwatch clock;
  const ChartSet charts = o.charts == ChartSource::keep
                              ? components_as_charts(mesh)
                              : segment_charts(mesh, segmentation_of(o, up, tile_mm)).charts;
  segment_seconds += clock.seconds();
  return map_or_halve(mesh, charts, o);
}

}  // namespace papilla::app
