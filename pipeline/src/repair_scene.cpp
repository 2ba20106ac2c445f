// SPDX-License-Identifier: MIT
#include "papilla/pipeline/repair_scene.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/io/node_places.hpp"
#include "papilla/meshing/deviation.hpp"
#include "papilla/pipeline/part_statistics.hpp"

namespace papilla {
namespace {

std::vector<RepairResult> repair_parts(Scene& scene, const RepairOptions& options, const ProgressCallback& progress) {
  std::vector<RepairResult> results(scene.parts.size());
  RepairOptions repair_options = options;
  const bool single = scene.parts.size() == 1;
  if (single) repair_options.progress = progress;
  SharedProgress done(single ? ProgressCallback() : progress, "repair", static_cast<double>(results.size()));
  oneapi::tbb::parallel_for(std::size_t{0}, results.size(), [&](std::size_t i) {
    try {
      results[i] = repair(std::move(scene.parts[i].mesh), repair_options);
    } catch (const InvalidInput& error) {
      throw InvalidInput("part '" + shown_name(scene.parts[i]) + "': " + error.what());
    }
    scene.parts[i].mesh = std::move(results[i].mesh);
    done.add(1);
  });
  return results;
}

/// The largest distance between any part's surface before and after, both ways; an upper bound over all points.
double measured_deviation(const std::vector<TriangleMesh>& before, const Scene& after) {
  double deviation = 0;
  for (std::size_t i = 0; i < before.size(); ++i)
    if (!before[i].triangles.empty() && !after.parts[i].mesh.triangles.empty())
      deviation = std::max(deviation, surface_deviation(before[i], after.parts[i].mesh).bound());
  return deviation;
}

/// Back sides of double sheets are dropped, so what is left must be seen from both.
void make_double_sided(Scene& scene, const std::vector<RepairResult>& results) {
  for (std::size_t i = 0; i < results.size(); ++i)
    if (results[i].counts.opposites > results[i].counts.walls)
      for (const std::uint32_t m : scene.parts[i].materials)
        if (m < scene.materials.size()) scene.materials[m].double_sided = true;
}

}  // namespace

RepairSceneResult repair_scene(Scene scene, const RepairSceneOptions& options, const ProgressCallback& progress) {
  const Stopwatch clock;
  RepairSceneResult result;
  result.before = total_statistics(part_statistics(scene, progress));
  if (!options.keep_copies) result.shared = share_identical_parts(scene);
  std::vector<TriangleMesh> originals;
  if (options.verify)
    for (const Part& part : scene.parts) originals.push_back(part.mesh);
  result.parts = repair_parts(scene, options.repair, progress);
  result.after = total_statistics(part_statistics(scene, progress));
  make_double_sided(scene, result.parts);
  result.sides = turn_sheets(scene, options.sides);
  for (std::size_t i = 0; i < result.parts.size(); ++i) {
    result.max_deviation_mm = std::max(result.max_deviation_mm, result.parts[i].max_deviation_mm);
    result.weld_tolerance_mm = std::max(result.weld_tolerance_mm, result.parts[i].weld_tolerance_mm);
    if (!result.parts[i].settled) result.unsettled.push_back(shown_name(scene.parts[i]));
  }
  if (options.verify) result.measured_deviation_mm = measured_deviation(originals, scene);
  result.scene = std::move(scene);
  result.seconds = clock.seconds();
  return result;
}

}  // namespace papilla
