// SPDX-License-Identifier: MIT
#include "part_charts.hpp"

#include "papilla/cache/stage_cache.hpp"
#include "papilla/param/grain_direction.hpp"

namespace papilla::detail {
namespace {

Flattening map_charts(const TriangleMesh& mesh, const ChartSet& charts, const MethodOptions& o,
                      std::vector<ChartChoice>& choices) {
  switch (o.method) {
    case UnwrapMethod::maillot: {
      MaillotResult result = flatten_maillot(mesh, charts, o.maillot);
      choices = std::move(result.choices);
      return std::move(result.flattening);
    }
    case UnwrapMethod::levy: {
      LevyResult result = flatten_levy(mesh, charts, o.levy);
      choices = std::move(result.choices);
      return std::move(result.flattening);
    }
    case UnwrapMethod::lscm: return flatten_lscm(mesh, charts, o.lscm);
    case UnwrapMethod::best: return flatten_best(mesh, charts, o.best);
    case UnwrapMethod::automatic: {
      AutomaticResult result = flatten_automatic(mesh, charts, o.automatic);
      choices = std::move(result.choices);
      return std::move(result.flattening);
    }
    default: return flatten_reference(mesh, charts, o.reference);
  }
}

/// Maps with a border on a circle need disks; the others leave holes of flat sheets as they are. Grain of known size
/// wants its direction kept.
SegmentationOptions segmentation_of(const MethodOptions& o, const PartContext& context) {
  SegmentationOptions segmentation = o.segmentation;
  const bool on_circle = o.method == UnwrapMethod::tutte || o.method == UnwrapMethod::mvc ||
                         (o.method == UnwrapMethod::levy && o.levy.border == LevyBorder::convex);
  segmentation.disks = on_circle;
  if (!(context.tile_mm.x > 0 && context.tile_mm.y > 0)) return segmentation;
  const PlacedGrain& grain = o.grains.front();
  switch (grain.source) {
    case GrainSource::up:
      segmentation.grain = [up = context.up](Vec3 normal) { return grain_direction(normal, up); };
      break;
    case GrainSource::longest:
    case GrainSource::direction:
      segmentation.grain = [d = normalized(grain.vector)](Vec3 normal) { return d - dot(d, normal) * normal; };
      break;
    case GrainSource::edge_loop: break;  // its direction does not follow from a normal
  }
  return segmentation;
}

/// Of charts that may be cut.
constexpr int k_most_halvings = 6;

}  // namespace

Flattening map_or_halve(const TriangleMesh& mesh, ChartSet charts, MethodOptions options, int most_halvings,
                        PartMemory& memory, std::vector<ChartChoice>& choices) {
  for (ChartMemory** of_method : {&options.maillot.memory, &options.levy.memory, &options.lscm.memory,
                                  &options.reference.memory, &options.best.memory, &options.automatic.best.memory})
    *of_method = options.charts == ChartSource::automatic ? &memory.maps : nullptr;
  if (!memory.opener) memory.opener.emplace(mesh);
  for (int i = 0;; ++i) {
    Flattening flattening = map_charts(memory.opener->open(charts), charts, options, choices);
    if (flattening.notes.empty() || i == most_halvings || options.deadline.passed()) {
      memory.opener->keep_cuts(charts.cuts, flattening.charts);
      return flattening;
    }
    std::vector<std::uint32_t> failed;
    for (const ChartNote& note : flattening.notes) failed.push_back(note.chart);
    if (!memory.halver) memory.halver.emplace(mesh);
    charts = memory.halver->halve(charts, failed);
  }
}

Flattening chart_and_map(const TriangleMesh& mesh, const MethodOptions& o, const PartContext& context,
                         PartMemory& memory, FlattenedPart& part) {
  const Stopwatch clock;
  SegmentationOptions segmentation = segmentation_of(o, context);
  segmentation.progress = [&o](const Progress& done) {
    report_progress(o.progress, done.stage, k_share_of_charts * done.fraction);
    return !o.deadline.passed();
  };
  const PlacedGrain& grain = o.grains.front();
  const auto segment = [&] {
    if (!memory.segmenter) memory.segmenter.emplace(mesh);
    return memory.segmenter->segment(segmentation).charts;
  };
  // A segmentation whose time is up is cancelled: what there is is whole. Its grain is a function, and not in the key.
  const ChartSet charts = remembered(o.cache, "charts", CacheUse::read_write, segment, mesh, segmentation, grain.source,
                                     grain.vector, context.up, segmentation.grain != nullptr)
                              .value;
  part.segment_seconds += clock.seconds();
  part.choices.clear();
  return map_or_halve(mesh, charts, o, k_most_halvings, memory, part.choices);
}

}  // namespace papilla::detail
