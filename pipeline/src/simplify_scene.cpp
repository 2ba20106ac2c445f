// SPDX-License-Identifier: MIT
#include "papilla/pipeline/simplify_scene.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

SimplifyResult simplify_part(const TriangleMesh& mesh, const SimplifySceneOptions& o) {
  if (mesh.triangles.empty() || (!o.tolerance_mm && !o.ratio)) return {mesh, mesh.triangles.size(), {}, {}, {}};
  SimplifyOptions options = o.simplify;
  if (o.tolerance_mm) options.tolerance_mm = *o.tolerance_mm;
  if (o.ratio)
    options.target_triangles = std::max<std::size_t>(
        1, static_cast<std::size_t>(std::ceil(*o.ratio * static_cast<double>(mesh.triangles.size()))));
  return simplify(mesh, options);
}

std::vector<SimplifyResult> simplify_parts(const Scene& scene, const SimplifySceneOptions& options,
                                           const ProgressCallback& progress) {
  std::vector<SimplifyResult> results(scene.parts.size());
  SharedProgress done(progress, "simplify", static_cast<double>(results.size()));
  oneapi::tbb::parallel_for(std::size_t{0}, results.size(), [&](std::size_t i) {
    try {
      results[i] = simplify_part(scene.parts[i].mesh, options);
    } catch (const InvalidInput& error) {
      throw InvalidInput("part '" + scene.parts[i].name + "': " + error.what());
    }
    done.add(1);
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
    result.budget = fit_scene_to_budget(scene, *options.budget, options.simplify);
    result.parts = std::move(result.budget->parts);
    finest_mm = result.budget->tolerance_mm;
  } else {
    result.parts = simplify_parts(scene, options, progress);
  }
  for (const SimplifyResult& part : result.parts) {
    result.triangles.push_back(part.mesh.triangles.size());
    if (part.triangles_before == 0) continue;
    result.max_deviation_mm = std::max(result.max_deviation_mm, part.deviation.bound());
    result.max_deviation_met_mm = std::max(result.max_deviation_met_mm, part.deviation.value());
  }
  std::vector<TriangleMesh> originals;
  for (std::size_t i = 0; i < result.parts.size(); ++i) {
    if (options.levels.asked()) originals.push_back(std::move(scene.parts[i].mesh));
    scene.parts[i].mesh = std::move(result.parts[i].mesh);
  }
  if (options.levels.asked()) result.levels = add_levels(scene, originals, options.levels, options.simplify, finest_mm);
  result.triangles_after = drawn_triangles(scene);
  result.scene = std::move(scene);
  result.seconds = clock.seconds();
  return result;
}

}  // namespace papilla
