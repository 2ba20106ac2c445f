// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "papilla/core/deadline.hpp"
#include "papilla/core/progress.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/meshing/triangle_budget.hpp"
#include "papilla/pipeline/assignment.hpp"
#include "papilla/pipeline/bake_stages.hpp"
#include "papilla/pipeline/materials.hpp"
#include "papilla/pipeline/object_textures.hpp"
#include "papilla/pipeline/perception.hpp"
#include "papilla/pipeline/scene_sides.hpp"
#include "papilla/pipeline/shared_parts.hpp"

namespace papilla {

/// Shares of a surface's area, or of that of its uv, in [0, 1].
struct UvDefects {
  double flipped = 0;      ///< Mirrored; charts of symmetric parts often are, and serve as well as others.
  double degenerate = 0;   ///< Without uv, or with a triangle of uv without area.
  double overlapping = 0;  ///< Of the uv: covered more than once, which pictures that tile don't mind.
};

/// The triangles of one part that share one material: what a rule is assigned to and a plan is made for.
struct PartSurface {
  std::uint32_t part = 0;
  std::uint32_t slot = 0;                ///< Of Part::materials.
  std::vector<std::uint32_t> triangles;  ///< Of the part's mesh, ascending.
  std::string material;                  ///< Name of an entry of Materials::materials; empty: nothing is assigned.
  double uv_mm_per_unit = 0;             ///< Millimetres of surface per unit of its own uv; 0 without uv.
  UvDefects uv_defects;                  ///< Of its own uv.
  std::string uv_note;                   ///< What was found about its own uv.
  std::vector<std::string> lost;         ///< Its pictures that new uv leave without a place.
  bool is_left_out = false;              ///< With its whole part.
  std::vector<std::uint8_t> turned;      ///< In place, per triangle, 1: turned over. Empty: none.
  bool becomes_double_sided = false;     ///< In place: its material does.
  SurfacePlan plan;
  std::string label;  ///< "part", or "part/material" when the part has several materials; without a name its path.
};

/// What comes before the baking of surfaces.
struct BakePlanOptions {
  PerceptionOptions perception;       ///< Parts to be left out.
  std::optional<std::size_t> budget;  ///< Triangles that the scene may draw.
  Deadline deadline;                  ///< Of the search for what meets it: SimplifyOptions::deadline.
  SceneSideOptions sides;             ///< `perception.view` tells where eyes are when `inside` is not given.
  bool keep_copies = false;           ///< Identical parts are not made instances of one.
  /// For an edit of the scene's file: nothing is shared, pictures stay, and so do triangles but for sheets with relief
  /// that face away, which would be felt inverted.
  bool in_place = false;
  std::vector<GltfOrigin::Level> levels;  ///< Coarser levels of detail of that file: get what the finest gets.
  bool strict = false;                    ///< A rule that takes no surface is an error.
};

/// A scene made ready to be baked, and what shall be done to each of its surfaces.
struct BakePlan {
  Scene scene;  ///< Sheets turned; identical parts that are assigned the same rules are shared; within the budget.
  SceneSides sides;
  std::vector<PartSurface> surfaces;
  std::vector<RuleUse> rules;  ///< Of every entry of Materials::assign; problems are warnings of the scene, too.
  ObjectTexturePlaces object_textures;    ///< Where decals and carriers go; problems are warnings of the scene, too.
  std::vector<SplitPart> split;           ///< Before identical parts were shared.
  std::vector<GltfOrigin::Level> levels;  ///< Those of the options, with the parts that they show now.
  std::vector<SharedPart> shared;
  ScenePerception perception;
  std::optional<BudgetResult> budget;         ///< Without its parts' meshes.
  std::vector<std::size_t> budget_triangles;  ///< Of each part within the budget.
  double perception_seconds = 0, simplify_seconds = 0;
};

/// Finds the surfaces of a scene, assigns the rules and decides for every surface which stages it needs. Nothing is
/// computed that a decision does not rest on.
/// @throws InvalidInput as measure_perception() and fit_scene_to_budget(), and for strict rules.
BakePlan plan_bake(Scene scene, const Materials& rules, const BakePlanOptions& options = {},
                   const ProgressCallback& progress = {});

/// Names of the materials whose grain the surfaces use, in order.
std::set<std::string> grains_of(const std::vector<PartSurface>& surfaces);

/// The decisions for a scene as it is: nothing is shared, left out or simplified.
/// @param assignment Of the scene's parts. @param perception Of them; empty when nothing was asked.
/// @param in_place As in BakePlanOptions.
std::vector<PartSurface> plan_surfaces(const Scene& scene, const Assignment& assignment,
                                       const std::vector<PartPerception>& perception = {}, bool in_place = false);

}  // namespace papilla
