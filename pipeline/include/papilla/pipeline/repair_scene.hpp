// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/meshing/repair.hpp"
#include "papilla/meshing/statistics.hpp"
#include "papilla/pipeline/scene_sides.hpp"
#include "papilla/pipeline/shared_parts.hpp"

namespace papilla {

struct RepairSceneOptions {
  RepairOptions repair;
  SceneSideOptions sides;    ///< Its cache is that of repairs, too.
  bool keep_copies = false;  ///< Do not make identical parts instances of one.
};

struct RepairSceneResult {
  Scene scene;
  std::vector<SharedPart> shared;
  SceneSides sides;
  MeshStatistics before;                    ///< Of all parts together.
  std::vector<RepairResult> parts;          ///< In the order of Scene::parts; without their meshes.
  RepairResult total;                       ///< total_repair() of these.
  StopReason stop = StopReason::converged;  ///< `time_limit`: some pieces stay as they came, because time was up.
  double seconds = 0;
};

/// What the file holds that a repaired scene was written to.
struct WrittenRepair {
  MeshStatistics after;    ///< Of all parts together, as they are read from it.
  double rounding_mm = 0;  ///< The most that its precision moves a vertex.

  /// How far the surface was moved, both ways.
  double max_deviation_mm(const RepairResult& total) const noexcept {
    return (total.lost_mm > total.added_mm ? total.lost_mm : total.added_mm) + rounding_mm;
  }
};

/// repair() of every part of a scene, then turn_sheets(); identical parts are shared first. Where the backs of double
/// sheets were dropped the materials become double sided: show_both_sides(). Parts run in parallel; the result does not
/// depend on the number of threads. After RepairOptions::deadline the rest stays as it came, and so do sheets.
/// @throws InvalidInput naming the part.
RepairSceneResult repair_scene(Scene scene, const RepairSceneOptions& options = {},
                               const ProgressCallback& progress = {});

}  // namespace papilla
