// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/meshing/simplify.hpp"
#include "papilla/meshing/triangle_budget.hpp"
#include "papilla/pipeline/perception.hpp"
#include "papilla/pipeline/shared_parts.hpp"

namespace papilla {

class StageCache;

/// Which coarser levels of detail parts get.
struct LevelOptions {
  std::optional<int> count;           ///< Levels beside the finest, each within four times the tolerance of the last.
  std::vector<double> tolerances_mm;  ///< Or these, ascending.

  bool asked() const noexcept { return count || !tolerances_mm.empty(); }
};

/// One level of one part.
struct LevelReport {
  std::uint32_t part = 0;
  std::size_t level = 0;  ///< From 1; 0: left out, because it would keep more than 90 % of the last one's triangles.
  double tolerance_mm = 0, max_deviation_mm = 0, screen_coverage = 0;
  std::size_t triangles_before = 0, triangles = 0;
  StopReason stop = StopReason::converged;  ///< SimplifyResult::stop.
};

/// Gives every part coarser levels: levels_of_detail() of `originals`, which its mesh was simplified from. The screen
/// coverage of a level is where its tolerance takes one of 2000 pixels, about what a headset shows from top to bottom:
/// diagonal / (2000 tolerance). Parts run in parallel.
/// @param originals In the order of the parts.
/// @param finest_mm Tolerance of the scene's meshes; 0 with `count`: levels start from 1e-4 of the largest diagonal.
/// @throws InvalidInput when the tolerances do not ascend from `finest_mm`; naming the part.
std::vector<LevelReport> add_levels(Scene& scene, std::span<const TriangleMesh> originals, const LevelOptions& options,
                                    const SimplifyOptions& simplify, double finest_mm,
                                    const StageCache* cache = nullptr);

/// For programs that do not know MSFT_lod: every level becomes a part, and each node that shows one keeps its place and
/// gets a child a level, named NAME_LOD0, NAME_LOD1, ... All of them are shown.
void levels_to_nodes(Scene& scene);

/// What simplify_scene() aims at: a tolerance, a share of each part's triangles, or a budget for the whole scene.
struct SimplifySceneOptions {
  std::optional<double> tolerance_mm;  ///< Largest distance between input and result, per part.
  std::optional<double> ratio;         ///< In (0, 1]: stop each part at this share of its triangles.
  std::optional<std::size_t> budget;   ///< Triangles that the scene may draw; not together with the two above.
  SimplifyOptions simplify;            ///< Its tolerance, target and progress are replaced.
  LevelOptions levels;                 ///< Coarser levels of detail beside the result.
  PerceptionOptions perception;        ///< Parts to be left out before.
  bool keep_copies = false;            ///< Do not make identical parts instances of one.
  const StageCache* cache = nullptr;   ///< Remembers what parts are simplified to, and their levels.
};

struct SimplifySceneResult {
  Scene scene;
  std::vector<SharedPart> shared;
  std::optional<ScenePerception> perception;  ///< When it was asked for.
  std::vector<SimplifyResult> parts;          ///< In the order of Scene::parts; without their meshes.
  std::vector<std::size_t> triangles;         ///< Of each part after.
  std::optional<BudgetResult> budget;         ///< Without its parts.
  std::vector<LevelReport> levels;
  std::size_t triangles_before = 0, triangles_after = 0;  ///< Drawn: every part as often as nodes show it.
  StopReason stop = StopReason::converged;                ///< `time_limit`: the deadline cut some part short.
  double max_deviation_mm = 0, max_deviation_met_mm = 0;  ///< Largest bound, largest distance that was met.
  double seconds = 0;
};

/// simplify() of every part of a scene within a tolerance, to a share of its triangles, or simplify_to_budget() of all;
/// identical parts are shared and parts that nobody perceives left out first. Parts run in parallel; the result does
/// not depend on the number of threads. SimplifyOptions::deadline ends it with what holds by then.
/// @throws InvalidInput naming the part; when a budget is combined with a tolerance or a ratio; as add_levels().
SimplifySceneResult simplify_scene(Scene scene, const SimplifySceneOptions& options,
                                   const ProgressCallback& progress = {});

/// simplify_to_budget() of a scene's parts, each counted as often as it is drawn. Does not change the scene.
/// @throws InvalidInput naming the part.
BudgetResult fit_scene_to_budget(const Scene& scene, std::size_t max_triangles, const SimplifyOptions& options = {});

/// Triangles that a scene draws: of every part as many times as nodes show it.
std::size_t drawn_triangles(const Scene& scene);

}  // namespace papilla
