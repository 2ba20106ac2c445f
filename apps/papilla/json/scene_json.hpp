// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "json/json.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/io/cad_reader.hpp"
#include "papilla/meshing/statistics.hpp"
#include "papilla/pipeline/bake_file.hpp"
#include "papilla/pipeline/measure_scene.hpp"
#include "papilla/pipeline/repair_scene.hpp"
#include "papilla/pipeline/simplify_scene.hpp"
#include "papilla/pipeline/unwrap_scene.hpp"
#include "papilla/pipeline/weather_scene.hpp"

namespace papilla::app {

// Results on scenes under the key names of docs/files.md.

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// [{seconds, error}].
Json trace_json(const Trace& trace);

/// The counters of `inspect`.
Json counters_json(const MeshStatistics& statistics);

/// {part, id, copy_of, max_distance_mm} a line.
Json shared_parts_json(const std::vector<SharedPart>& shared, const Scene& scene);

/// {part, instances, in_reach, instances_in_reach, visible_fraction, instances_seen, left_out, instances_left_out} a
/// line.
Json perception_json(const Scene& scene, const ScenePerception& perception);

/// {seen_from, eye_mm, enclosure, open_components, facing_away, ambiguous, skipped, parts[] {part, open_components,
/// facing_away, ambiguous, turned_triangles, left_facing_away, left_ambiguous, reasons[]}}; null when sheets were kept
/// as they are.
Json sides_json(const SceneSides& sides, const SceneSideOptions& options);
/// {seam_mm, visible_mm, mean_jump_mm, max_jump_mm, mean_turn_deg, turned_mm, per_size}.
Json seams_json(const SeamVisibility& seams);

/// {wanted, triangles, reached, tolerance_mm, trace[], parts[] {name, triangles_before, triangles_after,
/// max_deviation_mm, max_deviation_met_mm}}.
/// @param triangles_after Of each part.
Json budget_json(const Scene& scene, std::size_t wanted, const BudgetResult& budget,
                 const std::vector<SimplifyResult>& parts, const std::vector<std::size_t>& triangles_after);

/// What `inspect` says of a scene.
Json inspect_json(const Scene& scene, const std::vector<MeshStatistics>& statistics,
                  const std::optional<ScenePerception>& perception, const Json& sides);

/// {part, node, layers[], cad_materials[], colour, material} a surface and use.
Json nodes_json(const std::vector<SurfacePlace>& places);
Json tessellation_json(const Scene& scene, const CadReport& report);
/// {operations{}, deviations_mm{}, tolerance_mm, lost_mm, added_mm, sampled, refused{triangles, deviation_mm},
/// unfinished_triangles}: what
/// every verb says that repairs.
Json repair_numbers_json(const RepairResult& result);
Json repair_json(const RepairSceneResult& result, const WrittenRepair& written, const RepairSceneOptions& options);
Json simplify_json(const SimplifySceneResult& result, const SimplifySceneOptions& options);
Json unwrap_json(const UnwrapResult& result, const UnwrapOptions& options, const SceneDistortion& distortion);

/// The report's numbers by their key names in JSON; the keys of nested objects are joined by dots. Without those of
/// overlap when it was not looked for.
using DistortionNumbers = std::vector<std::pair<std::string, std::variant<std::uint64_t, double>>>;
DistortionNumbers distortion_numbers(const DistortionReport& report);

/// The report under the key names of `measure`.
Json distortion_json(const DistortionReport& report);
/// Null without any distortion.
Json worst_chart_json(const Scene& scene, const SceneDistortion& distortion);
Json histogram_json(const DistortionReport& report);

/// What a report says of a grain: {name, picture{}, class{}, lattice, group, period_mm[], height{}, roughness{},
/// maps[], plan[]}.
Json grain_json(const std::string& name, const Grain& grain);

/// {part, material, stage, run, reason} a line.
Json plan_json(const std::vector<PartSurface>& surfaces);
/// {material, steps[] {step, run, reason}, problem} a grain.
Json grain_plans_json(const std::vector<GrainPlan>& plans);
/// {part, material, mm_per_unit, flipped, degenerate, overlapping, note, lost[]} a line, of surfaces with grain.
Json own_uv_json(const std::vector<PartSurface>& surfaces);
/// {material, force_model{name, form, amplitude, sign, level}, friction_model{name, stiffness}, backing{stiffness,
/// depth_mm}, maps{quantity: {picture, range}}}, each null or empty where not stated, a line of a material that states
/// one.
Json contact_models_json(const Materials& rules);
/// {in_place, reason}.
Json way_json(const BakeWay& way);
/// {change, pointer} a line.
Json changes_json(const std::vector<GltfChange>& changes);
/// {for, surfaces, uses, problem} a rule or layer.
Json rules_json(const std::vector<RuleUse>& uses);
/// {decals[] {name, for, surfaces, triangles, turned_off, area_mm2, offset_mm, relief_mm}, replace[] {name, for,
/// carriers, triangles_before, triangles_after, saved, relief_mm}}.
Json object_textures_json(const ObjectTextures& made, const ObjectTexturePlaces& places);
/// Plan, parts, materials, distortion, identical parts, perception, budget, losses, warnings, seconds.
Json bake_json(const BakeResult& result, const BakeOptions& options);

Json weather_json(const WeatheredMaterial& material);
Json atlases_json(const std::vector<BakedAtlas>& atlases);

}  // namespace papilla::app
