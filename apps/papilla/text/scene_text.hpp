// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "papilla/io/cad_reader.hpp"
#include "papilla/meshing/statistics.hpp"
#include "papilla/pipeline/bake_file.hpp"
#include "papilla/pipeline/measure_scene.hpp"
#include "papilla/pipeline/repair_scene.hpp"
#include "papilla/pipeline/simplify_scene.hpp"

namespace papilla::app {

// Results on scenes for people, as lines of a terminal.

/// A row: the counters and `name`; header_row() heads the columns.
std::string header_row();
std::string counters_row(const std::string& name, const MeshStatistics& statistics);

/// What `inspect` says of a scene.
std::string inspect_text(const Scene& scene, const std::vector<MeshStatistics>& statistics,
                         const std::optional<ScenePerception>& perception, const SceneSides& sides);
/// A row a surface and use, with the names that rules select by.
std::string nodes_text(const std::vector<SurfacePlace>& places);
std::string tessellation_text(const Scene& scene, const CadReport& report);
/// Says that the time limit ended the work; empty for all other endings.
std::string ending_line(StopReason stop);
/// What a repair did, how far the surface moved, and what was not done; empty when there was nothing to do.
std::string repair_numbers_text(const RepairResult& result);
std::string repair_text(const RepairSceneResult& result, const WrittenRepair& written);
std::string simplify_text(const SimplifySceneResult& result, const SimplifySceneOptions& options);
/// What was not done as asked, a line each.
std::string unwrap_remarks(const UnwrapResult& result);

/// A line for parts that are open, and a row each for those that face away or have no side; empty without open ones.
/// @param turned They were turned, or are only counted.
std::string sides_text(const SceneSides& sides, bool turned);

/// A few lines on the distortion, and the chart that has most of it.
std::string distortion_text(const Scene& scene, const SceneDistortion& distortion);
/// Every triangle of the scene as a line of CSV.
std::string distortion_csv(const SceneDistortion& distortion);
/// How the area spreads over symmetric Dirichlet, as bars.
std::string histogram_text(const DistortionReport& report);

/// Whether a file is edited or written anew, and why.
std::string way_line(const BakeWay& way);
/// How much of an edited file is new or other; empty when it was written anew.
std::string changes_line(const std::vector<GltfChange>& changes);
/// One row a surface, the stages that run, why the others do not, what its own uv are like and what new ones cost.
std::string plan_table(const std::vector<PartSurface>& surfaces);
/// What the class of each grain's picture needs, step by step, and why.
std::string grains_text(const std::vector<GrainPlan>& grains);
/// A line a material of these surfaces that states a force or friction model; empty without.
std::string contact_models_text(const Materials& rules, const std::vector<PartSurface>& surfaces);
/// One row a rule: how many surfaces it took, and with all instances how many uses of them.
std::string rules_table(const std::vector<RuleUse>& uses, const Materials& rules);
/// A line a decal and a carrier: where it lies, and the triangles that are saved; empty without any.
std::string object_textures_text(const ObjectTextures& made);
/// A row a part that is left out or has uses that are; empty when there is none.
std::string left_out_table(const Scene& scene, const ScenePerception& perception);
/// One row a surface with grain.
std::string bake_table(const BakeResult& result);

}  // namespace papilla::app
