// SPDX-License-Identifier: MIT
#include "papilla/pipeline/unwrap_scene.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "papilla/cache/stage_cache.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/node_places.hpp"
#include "papilla/meshing/mesh_bounds.hpp"
#include "papilla/meshing/repair.hpp"
#include "papilla/meshing/uv_charts.hpp"
#include "papilla/meshing/weld.hpp"
#include "papilla/param/pack.hpp"
#include "papilla/pipeline/part_statistics.hpp"
#include "remembered_plan.hpp"
#include "unwrap_ahead.hpp"

namespace papilla {

template <class Stream, class Value>
requires std::is_same_v<std::remove_const_t<Value>, UnwrappedPart>
void visit_value(Stream& stream, Value& part) {
  stream(static_cast<std::conditional_t<std::is_const_v<Value>, const FlattenedPart, FlattenedPart>&>(part));
  stream(part.seams, part.grain_continued_mm, part.opposed_edges, part.shared_edges, part.nonmanifold_edges);
  stream(part.opposed_pairs, part.repaired, part.failure, part.repair_seconds, part.solve_seconds);
}

namespace {

/// A part on its way into a cache.
struct UnwrappedMesh {
  TriangleMesh mesh;  ///< Welded or repaired.
  UnwrappedPart part;
};

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

void pack(const UnwrapOptions& options, UnwrapResult& result) {
  const AllCharts all = gather(result.parts);
  const double gutter = options.gutter_mm.value_or(relative_gutter(all.uv));
  const Atlas atlas = pack_atlas(all.uv, all.charts, {.gutter_mm = gutter, .tile_mm = options.tile_mm});
  result.fill_rate = atlas.fill_rate;
  scatter(atlas.uv, result.parts);
}

double density_of(const std::string& part, const UnwrapOptions& options) {
  for (const auto& [pattern, density] : options.density)
    if (is_for_part(pattern, part)) return density;
  return 1;
}

/// Gives the parts channel 1.
void pack_unique_uv(const UnwrapOptions& options, UnwrapResult& result) {
  Scene& scene = result.scene;
  const AllCharts all = gather(result.parts);
  UniqueAtlasOptions unique{options.unique->texture_px, options.unique->gutter_px, {}};
  for (std::size_t p = 0; p < result.parts.size(); ++p)
    unique.density.insert(unique.density.end(), result.parts[p].flattening.charts.count,
                          density_of(shown_name(scene.parts[p]), options));
  UniqueAtlas atlas = pack_unique(all.uv, all.charts, unique);
  auto next = atlas.uv.values.begin();
  for (std::size_t p = 0; p < result.parts.size(); ++p) {
    const CornerAttribute<Vec2>& uv = result.parts[p].flattening.uv;
    if (uv.empty()) continue;
    const auto end = next + static_cast<std::ptrdiff_t>(uv.values.size());
    scene.parts[p].mesh.uv1 = {{next, end}, uv.indices};
    next = end;
  }
  atlas.uv = {};
  result.unique = std::move(atlas);
}

/// Counts the edges at which charts end because of what the mesh is.
void count_edges(const TriangleMesh& mesh, UnwrappedPart& part) {
  struct Side {
    Index low, high;
    bool up;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index from = t[k], to = t[(k + 1) % 3];
      if (from != to) sides.push_back({std::min(from, to), std::max(from, to), from < to});
    }
  std::sort(sides.begin(), sides.end());
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) ++end;
    const auto up = static_cast<std::size_t>(std::count_if(sides.begin() + static_cast<std::ptrdiff_t>(begin),
                                                           sides.begin() + static_cast<std::ptrdiff_t>(end),
                                                           [](const Side& side) { return side.up; }));
    part.shared_edges += end - begin > 1;
    part.nonmanifold_edges += end - begin > 2;
    part.opposed_edges += std::size_t{up > 1} + std::size_t{end - begin - up > 1};
    part.opposed_pairs += end - begin == 2 && up != 1;
  }
}

void require_uv_of_parts(const Scene& scene) {
  for (const Part& part : scene.parts) try {
      require_uv(part.mesh);
    } catch (const InvalidInput& error) {
      throw InvalidInput("part '" + shown_name(part) + "': " + error.what());
    }
}

/// The name of the part where the options mean some part by its name: identical parts of other names, and of scenes of
/// another size, share results.
std::string named_part(const PartContext& context, const MethodOptions& method) {
  return named_parts(method).empty() ? std::string() : context.part;
}

/// flatten_part(), which other grain on the same surface leaves as it is.
FlattenedPart remembered_map(const TriangleMesh& mesh, const PartContext& context, const MethodOptions& method) {
  const auto make = [&] { return flatten_part(mesh, context, method); };
  const bool has_tile = context.tile_mm.x > 0 && context.tile_mm.y > 0;
  auto [part, found] = remembered(method.cache, "map", use_until(method.deadline), make, mesh, method, context.up,
                                  has_tile, named_part(context, method), reason_to_project(context));
  if (found) part.segment_seconds = 0;
  return std::move(part);
}

/// The first stages of unwrap_part(): the mesh welded or repaired, charts and uv.
UnwrappedPart map_part(TriangleMesh& mesh, const PartContext& context, const UnwrapOptions& options) {
  UnwrappedPart result;
  const Stopwatch repair_clock;
  if (options.repair) {
    RepairOptions in_time;
    in_time.deadline = options.method.deadline;
    const auto make = [&] { return repair(std::move(mesh), in_time); };
    result.repaired =
        remembered(options.method.cache, "repair", use_until(in_time.deadline), make, mesh, in_time).value;
    mesh = std::exchange(result.repaired->mesh, {});
  } else {
    mesh = weld_equal(std::move(mesh)).mesh;
  }
  result.repair_seconds = repair_clock.seconds();
  count_edges(mesh, result);
  const Stopwatch clock;
  static_cast<FlattenedPart&>(result) = remembered_map(mesh, context, options.method);
  result.solve_seconds = clock.seconds() - result.segment_seconds;
  return result;
}

/// The context of the mesh itself.
PartContext context_of(const TriangleMesh& mesh, PartContext context) {
  context.extent_mm = bounds_of(mesh).diagonal();
  return context;
}

/// What unwrap_part() makes, without looking into a cache for the whole.
UnwrappedPart make_uv(TriangleMesh& mesh, const PartContext& context, const UnwrapOptions& options) {
  UnwrappedPart result = map_part(mesh, context, options);
  const Stopwatch clock;
  if (options.method.method != UnwrapMethod::environment) {
    AlignedPhase aligned = align_phase(mesh, result.flattening, {.tile_mm = options.tile_mm});
    result.flattening.uv = std::move(aligned.uv);
    result.grain_continued_mm = aligned.continued_mm;
    result.seams =
        seam_visibility(mesh, result.flattening.uv, {.tile_mm = options.tile_mm, .grain_mm = grain_size(options)});
  }
  result.solve_seconds += clock.seconds();
  return result;
}

}  // namespace

double grain_size(const UnwrapOptions& options) {
  if (options.grain_mm) return *options.grain_mm;
  const double tile = std::min(options.tile_mm.x, options.tile_mm.y);
  return tile > 0 ? tile / 8 : 1;
}

PartContext unwrap_context(const Scene& scene, Vec2 tile_mm) {
  PartContext context;
  context.up = scene.up;
  context.tile_mm = tile_mm;
  context.parts = scene.parts.size();
  context.scene_extent_mm = scene_bounds(scene).diagonal();
  return context;
}

Digest uv_key(const TriangleMesh& mesh, PartContext context, const UnwrapOptions& options) {
  context = context_of(mesh, std::move(context));
  const MethodOptions& method = options.method;
  return key_of("uv", mesh, options.repair, options.tile_mm, grain_size(options), method, context.up, context.tile_mm,
                named_part(context, method), reason_to_project(context));
}

UnwrappedPart unwrap_part(TriangleMesh& mesh, const PartContext& context, const UnwrapOptions& options) {
  const PartContext own = context_of(mesh, context);
  const MethodOptions& method = options.method;
  if (method.cache == nullptr) return make_uv(mesh, own, options);
  const auto make = [&] {
    UnwrappedMesh made{mesh, {}};
    made.part = make_uv(made.mesh, own, options);
    return made;
  };
  auto [result, found] =
      remembered_by(uv_key(mesh, context, options), *method.cache, "uv", use_until(method.deadline), make);
  mesh = std::move(result.mesh);
  if (found) result.part.repair_seconds = result.part.segment_seconds = result.part.solve_seconds = 0;
  return std::move(result.part);
}

void unwrap_ahead(TriangleMesh mesh, const PartContext& context, const UnwrapOptions& options) {
  const PartContext own = context_of(mesh, context);
  map_part(mesh, own, options);
}

UnwrapResult unwrap_scene(Scene scene, const UnwrapOptions& options, const ProgressCallback& progress) {
  const Stopwatch clock;
  if (std::all_of(scene.parts.begin(), scene.parts.end(), [](const Part& p) { return p.mesh.triangles.empty(); }))
    throw InvalidInput("no part has triangles to unwrap");
  if (takes_charts(options.method.method) && options.method.charts == ChartSource::uv) require_uv_of_parts(scene);
  UnwrapResult result;
  result.scene = std::move(scene);
  double triangles = 0;
  for (const Part& part : result.scene.parts) triangles += static_cast<double>(part.mesh.triangles.size());
  UnwrapOptions in_time = options;
  in_time.sides.cache = options.method.cache;
  in_time.sides.deadline = in_time.method.deadline =
      options.method.deadline.earlier_by(k_seconds_to_finish * triangles);
  result.sides = turn_sheets(result.scene, in_time.sides);
  std::vector<Part>& parts = result.scene.parts;
  result.parts.resize(parts.size());
  result.grain_mm = grain_size(options);
  const PartContext shared_context = unwrap_context(result.scene, options.tile_mm);
  std::vector<std::exception_ptr> failures(parts.size());
  std::vector<double> start(parts.size(), 0);
  SharedProgress done(progress, "unwrap", triangles);
  oneapi::tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t p) {
    const std::string place = "part '" + shown_name(parts[p]) + "': ";
    WorkProgress work(done, static_cast<double>(parts[p].mesh.triangles.size()));
    start[p] = clock.seconds();
    try {
      PartContext context = shared_context;
      context.part = shown_name(parts[p]);
      UnwrapOptions own = in_time;
      own.method.progress = work.callback();
      result.parts[p] = unwrap_part(parts[p].mesh, context, own);
    } catch (const SolverFailure& error) {
      result.parts[p].failure = place + error.what();
      failures[p] = std::make_exception_ptr(SolverFailure(result.parts[p].failure));
    } catch (const InvalidInput& error) {
      result.parts[p].failure = place + error.what();
      failures[p] = std::make_exception_ptr(InvalidInput(result.parts[p].failure));
    }
    work.reach(1);
  });
  if (std::all_of(failures.begin(), failures.end(), [](const auto& failure) { return failure != nullptr; }))
    std::rethrow_exception(failures.front());
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const UnwrappedPart& part = result.parts[p];
    result.seconds.segment += part.segment_seconds;
    result.seconds.solve += part.solve_seconds;
    result.stop = worse(result.stop, part.flattening.stop);
    for (const TraceSample& s : part.flattening.trace) result.trace.push_back({start[p] + s.seconds, s.error});
  }
  std::stable_sort(result.trace.begin(), result.trace.end(),
                   [](const TraceSample& a, const TraceSample& b) { return a.seconds < b.seconds; });
  const Stopwatch pack_clock;
  if (options.method.method != UnwrapMethod::environment) {
    if (options.unique) pack_unique_uv(options, result);
    if (options.layout == UvLayout::atlas) pack(options, result);
  }
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!result.parts[p].failure.empty()) continue;
    parts[p].mesh.uv = result.parts[p].flattening.uv;
    result.charts += result.parts[p].flattening.charts.count;
  }
  result.seconds.pack = pack_clock.seconds();
  result.seconds.total = clock.seconds();
  return result;
}

}  // namespace papilla
