// SPDX-License-Identifier: MIT
#include "papilla/pipeline/repair_scene.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

#include "papilla/cache/stage_cache.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/io/node_places.hpp"
#include "papilla/pipeline/part_statistics.hpp"

namespace papilla {
namespace {

std::vector<RepairResult> repair_parts(Scene& scene, const RepairOptions& options, const StageCache* cache,
                                       const ProgressCallback& progress) {
  std::vector<RepairResult> results(scene.parts.size());
  RepairOptions repair_options = options;
  const bool single = scene.parts.size() == 1;
  if (single) repair_options.progress = progress;
  SharedProgress done(single ? ProgressCallback() : progress, "repair", static_cast<double>(results.size()));
  oneapi::tbb::parallel_for(std::size_t{0}, results.size(), [&](std::size_t i) {
    try {
      const auto make = [&] { return repair(std::move(scene.parts[i].mesh), repair_options); };
      results[i] =
          remembered(cache, "repair", use_until(repair_options.deadline), make, scene.parts[i].mesh, repair_options)
              .value;
    } catch (const InvalidInput& error) {
      throw InvalidInput("part '" + shown_name(scene.parts[i]) + "': " + error.what());
    }
    scene.parts[i].mesh = std::move(results[i].mesh);
    done.add(1);
  });
  return results;
}

/// Backs of double sheets are dropped, so what is left must be seen from both sides.
std::set<PartSlot> slots_without_back(const std::vector<RepairResult>& parts) {
  std::set<PartSlot> slots;
  for (std::uint32_t p = 0; p < parts.size(); ++p)
    for (const std::uint32_t slot : parts[p].two_sided) slots.emplace(p, slot);
  return slots;
}

}  // namespace

RepairSceneResult repair_scene(Scene scene, const RepairSceneOptions& options, const ProgressCallback& progress) {
  const Stopwatch clock;
  RepairSceneResult result;
  result.before = total_statistics(part_statistics(scene, progress));
  if (!options.keep_copies) result.shared = share_identical_parts(scene);
  result.parts = repair_parts(scene, options.repair, options.sides.cache, progress);
  result.total = total_repair(result.parts);
  show_both_sides(scene, slots_without_back(result.parts), options.sides.add_materials);
  if (result.total.unfinished_triangles > 0) result.stop = StopReason::time_limit;
  result.sides = turn_sheets(scene, options.sides);
  result.scene = std::move(scene);
  result.seconds = clock.seconds();
  return result;
}

}  // namespace papilla
