// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/meshing/repair.hpp"
#include "papilla/meshing/statistics.hpp"
#include "papilla/pipeline/scene_sides.hpp"
#include "papilla/pipeline/shared_parts.hpp"

namespace papilla {

struct RepairSceneOptions {
  RepairOptions repair;
  SceneSideOptions sides;
  bool verify = false;       ///< Measure the deviation from the input, not only bound it.
  bool keep_copies = false;  ///< Do not make identical parts instances of one.
};

struct RepairSceneResult {
  Scene scene;
  std::vector<SharedPart> shared;
  SceneSides sides;
  MeshStatistics before, after;                 ///< Of all parts together.
  std::vector<RepairResult> parts;              ///< In the order of Scene::parts; without their meshes.
  double max_deviation_mm = 0;                  ///< The largest bound of any part.
  double weld_tolerance_mm = 0;                 ///< The largest of any part.
  std::optional<double> measured_deviation_mm;  ///< Both ways, an upper bound over all points; when asked to verify.
  std::vector<std::string> unsettled;           ///< Names of parts that were still changing when the passes ended.
  double seconds = 0;
};

/// repair() of every part of a scene, then turn_sheets(); identical parts are shared first. Where the back sides of
/// double sheets were dropped the materials become double sided. Parts run in parallel; the result does not depend on
/// the number of threads.
/// @throws InvalidInput naming the part.
RepairSceneResult repair_scene(Scene scene, const RepairSceneOptions& options = {},
                               const ProgressCallback& progress = {});

}  // namespace papilla
