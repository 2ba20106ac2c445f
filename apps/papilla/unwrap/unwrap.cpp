// SPDX-License-Identifier: GPL-3.0-or-later
#include "unwrap/unwrap.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "papilla/core/error.hpp"
#include "papilla/meshing/mesh_bounds.hpp"
#include "papilla/meshing/weld.hpp"
#include "papilla/param/pack.hpp"

namespace papilla::app {
namespace {

/// The uv and charts of all parts that have some, in one list: chart and value numbers follow one another.
struct AllCharts {
  CornerAttribute<Vec2> uv;
  ChartSet charts;
};

AllCharts gather(const std::vector<UnwrappedPart>& parts) {
  AllCharts all;
  for (const UnwrappedPart& part : parts) {
    const Flattening& f = part.flattening;
    const auto first = static_cast<Index>(all.uv.values.size());
    all.uv.values.insert(all.uv.values.end(), f.uv.values.begin(), f.uv.values.end());
    for (const Triangle& t : f.uv.indices) all.uv.indices.push_back({first + t[0], first + t[1], first + t[2]});
    for (const std::uint32_t c : f.charts.of_triangle) all.charts.of_triangle.push_back(all.charts.count + c);
    all.charts.count += f.charts.count;
  }
  return all;
}

/// Gives the values of `uv`, in the order of gather(), back to the parts.
void scatter(const CornerAttribute<Vec2>& uv, std::vector<UnwrappedPart>& parts) {
  auto next = uv.values.begin();
  for (UnwrappedPart& part : parts) {
    const auto end = next + static_cast<std::ptrdiff_t>(part.flattening.uv.values.size());
    std::copy(next, end, part.flattening.uv.values.begin());
    next = end;
  }
}

/// Half a percent of the side of a square that holds the area of all charts.
double relative_gutter(const CornerAttribute<Vec2>& uv) {
  double area = 0;
  for (const Triangle& t : uv.indices)
    area += 0.5 * std::abs(cross(uv.values[t[1]] - uv.values[t[0]], uv.values[t[2]] - uv.values[t[0]]));
  return 0.005 * std::sqrt(area);
}

void place(const Scene& scene, const UnwrapOptions& options, UnwrapReport& report) {
  for (std::size_t p = 0; p < report.parts.size(); ++p) {
    Flattening& f = report.parts[p].flattening;
    if (f.uv.empty()) continue;
    AlignedPhase aligned = align_phase(scene.parts[p].mesh, f, {.tile_mm = options.tile_mm});
    f.uv = std::move(aligned.uv);
    report.parts[p].grain_continued_mm = aligned.continued_mm;
    report.parts[p].seams =
        seam_visibility(scene.parts[p].mesh, f.uv, {.tile_mm = options.tile_mm, .grain_mm = report.grain_mm});
  }
  if (options.layout == UvLayout::tile) return;
  const AllCharts all = gather(report.parts);
  const double gutter = options.gutter_mm.value_or(relative_gutter(all.uv));
  const Atlas atlas = pack_atlas(all.uv, all.charts, {.gutter_mm = gutter, .tile_mm = options.tile_mm});
  report.fill_rate = atlas.fill_rate;
  scatter(atlas.uv, report.parts);
}

double density_of(const std::string& part, const UnwrapOptions& options) {
  for (const auto& [pattern, density] : options.density)
    if (is_for_part(pattern, part)) return density;
  return 1;
}

/// Gives the parts channel 1.
void place_unique(Scene& scene, const UnwrapOptions& options, UnwrapReport& report) {
  const AllCharts all = gather(report.parts);
  UniqueAtlasOptions unique{options.unique->texture_px, options.unique->gutter_px, {}};
  for (std::size_t p = 0; p < report.parts.size(); ++p)
    unique.density.insert(unique.density.end(), report.parts[p].flattening.charts.count,
                          density_of(scene.parts[p].name, options));
  UniqueAtlas atlas = pack_unique(all.uv, all.charts, unique);
  auto next = atlas.uv.values.begin();
  for (std::size_t p = 0; p < report.parts.size(); ++p) {
    const CornerAttribute<Vec2>& uv = report.parts[p].flattening.uv;
    if (uv.empty()) continue;
    const auto end = next + static_cast<std::ptrdiff_t>(uv.values.size());
    scene.parts[p].mesh.uv1 = {{next, end}, uv.indices};
    next = end;
  }
  atlas.uv = {};
  report.unique = std::move(atlas);
}

/// Edges through which two triangles or more run in the same direction.
std::size_t opposed_edges(const TriangleMesh& mesh) {
  std::vector<std::pair<Index, Index>> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) sides.push_back({t[k], t[(k + 1) % 3]});
  std::sort(sides.begin(), sides.end());
  std::size_t count = 0;
  for (std::size_t i = 1; i < sides.size(); ++i)
    count += sides[i] == sides[i - 1] && (i == 1 || sides[i] != sides[i - 2]);
  return count;
}

double grain_size(const UnwrapOptions& options) {
  if (options.grain_mm) return *options.grain_mm;
  const double tile = std::min(options.tile_mm.x, options.tile_mm.y);
  return tile > 0 ? tile / 8 : 1;
}

/// What the parts have in common.
PartContext context_of(const Scene& scene, const UnwrapOptions& options) {
  PartContext context;
  context.up = scene.up;
  context.tile_mm = options.tile_mm;
  context.parts = scene.parts.size();
  TriangleMesh all;
  for (const Part& part : scene.parts)
    all.positions.insert(all.positions.end(), part.mesh.positions.begin(), part.mesh.positions.end());
  context.scene_extent_mm = bounds_of(all).diagonal();
  return context;
}

void add_trace(const Flattening& flattening, double start, UnwrapReport& report) {
  for (TraceSample sample : flattening.trace) report.trace.push_back({start + sample.seconds, sample.error});
  // The worst ending of any part is the scene's.
  if (flattening.stop == StopReason::iteration_limit || report.stop == StopReason::direct)
    report.stop = flattening.stop;
}

}  // namespace

UnwrapReport unwrap_scene(Scene& scene, const UnwrapOptions& options, const ProgressCallback& progress) {
  const Stopwatch clock;
  if (std::all_of(scene.parts.begin(), scene.parts.end(), [](const Part& p) { return p.mesh.triangles.empty(); }))
    throw InvalidInput("no part has triangles to unwrap");
  UnwrapReport report;
  report.parts.resize(scene.parts.size());
  report.grain_mm = grain_size(options);
  PartContext context = context_of(scene, options);
  std::exception_ptr first_failure;
  bool any = false;
  for (std::size_t p = 0; p < scene.parts.size(); ++p) {
    report_progress(progress, "unwrap", static_cast<double>(p) / static_cast<double>(scene.parts.size()));
    Part& part = scene.parts[p];
    UnwrappedPart& result = report.parts[p];
    try {
      part.mesh = weld_equal(std::move(part.mesh)).mesh;
      result.opposed_edges = opposed_edges(part.mesh);
      const double start = clock.seconds();
      context.part = part.name;
      FlattenedPart flattened = flatten_part(part.mesh, context, options.method);
      report.seconds.segment += flattened.segment_seconds;
      report.seconds.solve += clock.seconds() - start - flattened.segment_seconds;
      result.flattening = std::move(flattened.flattening);
      result.method = std::move(flattened.method);
      result.reason = std::move(flattened.reason);
      result.choices = std::move(flattened.choices);
      add_trace(result.flattening, start, report);
      any = true;
    } catch (const SolverFailure& error) {
      result.failure = "part '" + part.name + "': " + error.what();
      if (!first_failure) first_failure = std::make_exception_ptr(SolverFailure(result.failure));
    } catch (const InvalidInput& error) {
      result.failure = "part '" + part.name + "': " + error.what();
      if (!first_failure) first_failure = std::make_exception_ptr(InvalidInput(result.failure));
    }
  }
  if (!any && first_failure) std::rethrow_exception(first_failure);
  const double start = clock.seconds();
  if (options.method.method != UnwrapMethod::environment) {
    if (options.unique) place_unique(scene, options, report);
    place(scene, options, report);
  }
  for (std::size_t p = 0; p < scene.parts.size(); ++p) {
    if (!report.parts[p].failure.empty()) continue;
    scene.parts[p].mesh.uv = report.parts[p].flattening.uv;
    report.charts += report.parts[p].flattening.charts.count;
  }
  report.seconds.pack = clock.seconds() - start;
  report.seconds.total = clock.seconds();
  return report;
}

}  // namespace papilla::app
