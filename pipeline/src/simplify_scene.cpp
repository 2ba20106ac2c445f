// SPDX-License-Identifier: MIT
#include "papilla/pipeline/simplify_scene.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "papilla/cache/stage_cache.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/node_places.hpp"
#include "papilla/meshing/mesh_bounds.hpp"
#include "papilla/meshing/simplify.hpp"
#include "papilla/pipeline/level_scenes.hpp"

namespace papilla {
namespace {

SimplifyResult simplify_part(const TriangleMesh& mesh, const SimplifySceneOptions& o, ProgressCallback progress) {
  if (mesh.triangles.empty() || (!o.tolerance_mm && !o.ratio)) return {mesh, mesh.triangles.size(), {}, {}, {}};
  SimplifyOptions options = o.simplify;
  options.progress = std::move(progress);
  if (o.tolerance_mm) options.tolerance_mm = *o.tolerance_mm;
  if (o.ratio)
    options.target_triangles = std::max<std::size_t>(
        1, static_cast<std::size_t>(std::ceil(*o.ratio * static_cast<double>(mesh.triangles.size()))));
  const auto make = [&] { return simplify(mesh, options); };
  return remembered(o.cache, "simplify", use_until(options.deadline), make, mesh, options).value;
}

std::vector<SimplifyResult> simplify_parts(const Scene& scene, const SimplifySceneOptions& options,
                                           const ProgressCallback& progress) {
  std::vector<SimplifyResult> results(scene.parts.size());
  double triangles = 0;
  for (const Part& part : scene.parts) triangles += static_cast<double>(part.mesh.triangles.size());
  SharedProgress done(progress, "simplify", triangles);
  oneapi::tbb::parallel_for(std::size_t{0}, results.size(), [&](std::size_t i) {
    WorkProgress work(done, static_cast<double>(scene.parts[i].mesh.triangles.size()));
    try {
      results[i] = simplify_part(scene.parts[i].mesh, options, work.callback());
    } catch (const InvalidInput& error) {
      throw InvalidInput("part '" + shown_name(scene.parts[i]) + "': " + error.what());
    }
    work.reach(1);
  });
  return results;
}

}  // namespace

std::size_t drawn_triangles(const Scene& scene) {
  std::size_t triangles = 0;
  for (const Instance& use : instances(scene)) triangles += scene.parts[use.part].mesh.triangles.size();
  return triangles;
}

BudgetResult fit_scene_to_budget(const Scene& scene, std::size_t max_triangles, const SimplifyOptions& options) {
  std::vector<BudgetPart> parts;
  for (const Part& part : scene.parts) parts.push_back({&part.mesh, 1, 0});
  for (const Instance& use : instances(scene)) ++parts[use.part].instances;
  return simplify_to_budget(parts, max_triangles, options);
}

SimplifySceneResult simplify_scene(Scene scene, const SimplifySceneOptions& options, const ProgressCallback& progress) {
  if (options.budget && (options.tolerance_mm || options.ratio))
    throw InvalidInput("simplify_scene: a budget cannot be combined with a tolerance or a ratio");
  const Stopwatch clock;
  SimplifySceneResult result;
  result.triangles_before = drawn_triangles(scene);
  if (!options.keep_copies) result.shared = share_identical_parts(scene);
  if (options.perception.asked()) {
    result.perception = measure_perception(scene, options.perception, progress);
    leave_out(scene, *result.perception);
  }
  double finest_mm = options.tolerance_mm.value_or(0);
  if (options.budget) {
    SimplifyOptions simplify = options.simplify;
    simplify.progress = progress;
    result.budget = fit_scene_to_budget(scene, *options.budget, simplify);
    result.parts = std::move(result.budget->parts);
    finest_mm = result.budget->tolerance_mm;
  } else {
    result.parts = simplify_parts(scene, options, progress);
  }
  for (const SimplifyResult& part : result.parts) {
    result.triangles.push_back(part.mesh.triangles.size());
    if (part.triangles_before == 0) continue;
    if (part.stop == StopReason::time_limit) result.stop = part.stop;
    result.max_deviation_mm = std::max(result.max_deviation_mm, part.deviation.bound());
    result.max_deviation_met_mm = std::max(result.max_deviation_met_mm, part.deviation.value());
  }
  std::vector<TriangleMesh> originals;
  for (std::size_t i = 0; i < result.parts.size(); ++i) {
    if (options.levels.asked()) originals.push_back(std::move(scene.parts[i].mesh));
    scene.parts[i].mesh = std::move(result.parts[i].mesh);
  }
  if (options.levels.asked())
    result.levels = add_levels(scene, originals, options.levels, options.simplify, finest_mm, options.cache);
  for (const LevelReport& level : result.levels)
    if (level.stop == StopReason::time_limit) result.stop = level.stop;
  result.triangles_after = drawn_triangles(scene);
  result.scene = std::move(scene);
  result.seconds = clock.seconds();
  return result;
}

namespace {

constexpr double k_level_factor = 4;        ///< Between the tolerances of --lod: about a quarter of the triangles.
constexpr double k_first_tolerance = 1e-4;  ///< Of the largest part's diagonal.
constexpr double k_most_kept = 0.9;

std::vector<double> tolerances(std::span<const TriangleMesh> meshes, const LevelOptions& options, double finest_mm) {
  std::vector<double> result = options.tolerances_mm;
  if (options.count) {
    double largest = 0;
    for (const TriangleMesh& mesh : meshes) largest = std::max(largest, bounds_of(mesh).diagonal());
    double tolerance = finest_mm > 0 ? k_level_factor * finest_mm : k_first_tolerance * largest;
    for (int level = 0; level < *options.count && tolerance > 0; ++level, tolerance *= k_level_factor)
      result.push_back(tolerance);
  }
  double last = finest_mm;
  for (const double tolerance : result) {
    if (!(tolerance > last))
      throw InvalidInput(fmt::format("add_levels: tolerance {} mm does not exceed {} mm", tolerance, last));
    last = tolerance;
  }
  return result;
}

/// A level, and whether it has few enough triangles to be kept.
struct Level {
  double tolerance_mm = 0;
  SimplifyResult result;
  bool kept = true;
};

std::vector<Level> coarser_levels(const TriangleMesh& mesh, std::size_t finest_triangles,
                                  const std::vector<double>& tolerances, const SimplifyOptions& simplify,
                                  const StageCache* cache) {
  std::vector<Level> levels;
  if (mesh.triangles.empty()) return levels;
  const auto make = [&] { return levels_of_detail(mesh, tolerances, simplify); };
  std::vector<SimplifyResult> all =
      remembered(cache, "levels", use_until(simplify.deadline), make, mesh, tolerances, simplify).value;
  std::size_t last = finest_triangles;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t triangles = all[i].mesh.triangles.size();
    const bool kept = triangles > 0 && static_cast<double>(triangles) <= k_most_kept * static_cast<double>(last);
    if (kept) last = triangles;
    levels.push_back({tolerances[i], std::move(all[i]), kept});
  }
  return levels;
}

}  // namespace

std::vector<LevelReport> add_levels(Scene& scene, std::span<const TriangleMesh> originals, const LevelOptions& options,
                                    const SimplifyOptions& simplify, double finest_mm, const StageCache* cache) {
  const std::vector<double> wanted = tolerances(originals, options, finest_mm);
  std::vector<std::vector<Level>> levels(scene.parts.size());
  oneapi::tbb::parallel_for(std::size_t{0}, levels.size(), [&](std::size_t i) {
    try {
      levels[i] = coarser_levels(originals[i], scene.parts[i].mesh.triangles.size(), wanted, simplify, cache);
    } catch (const InvalidInput& error) {
      throw InvalidInput("part '" + shown_name(scene.parts[i]) + "': " + error.what());
    }
  });
  std::vector<LevelReport> reports;
  for (std::uint32_t i = 0; i < levels.size(); ++i) {
    Part& part = scene.parts[i];
    const double size = bounds_of(originals[i]).diagonal();
    part.levels.clear();
    for (Level& level : levels[i]) {
      LevelReport report{i,
                         0,
                         level.tolerance_mm,
                         level.result.deviation.bound(),
                         0,
                         level.result.triangles_before,
                         level.result.mesh.triangles.size(),
                         level.result.stop};
      if (level.kept) {
        report.screen_coverage = coverage_of_tolerance(size, level.tolerance_mm);
        part.levels.push_back({std::move(level.result.mesh), report.screen_coverage});
        report.level = part.levels.size();
      }
      reports.push_back(report);
    }
  }
  return reports;
}

void levels_to_nodes(Scene& scene) {
  const std::size_t parts = scene.parts.size(), nodes = scene.nodes.size();
  std::vector<std::vector<std::uint32_t>> of_part(parts);
  for (std::size_t i = 0; i < parts; ++i) {
    std::vector<PartLevel> levels = std::move(scene.parts[i].levels);
    scene.parts[i].levels.clear();
    for (std::size_t level = 0; level < levels.size(); ++level) {
      Part part = scene.parts[i];
      part.mesh = std::move(levels[level].mesh);
      part.name += fmt::format("_LOD{}", level + 1);
      part.id += fmt::format("_LOD{}", level + 1);
      of_part[i].push_back(static_cast<std::uint32_t>(scene.parts.size()));
      scene.parts.push_back(std::move(part));
    }
    if (!levels.empty()) of_part[i].insert(of_part[i].begin(), static_cast<std::uint32_t>(i));
  }
  for (std::size_t n = 0; n < nodes; ++n) {
    if (!scene.nodes[n].part || of_part[*scene.nodes[n].part].empty()) continue;
    const std::uint32_t shown = *scene.nodes[n].part;
    const std::string name = scene.nodes[n].name.empty() ? scene.parts[shown].name : scene.nodes[n].name;
    scene.nodes[n].part.reset();
    for (std::size_t level = 0; level < of_part[shown].size(); ++level) {
      Node child;
      child.name = fmt::format("{}_LOD{}", name, level);
      child.part = of_part[shown][level];
      scene.nodes[n].children.push_back(static_cast<std::uint32_t>(scene.nodes.size()));
      scene.nodes.push_back(std::move(child));
    }
  }
}

}  // namespace papilla
