// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/param/measure.hpp"
#include "papilla/pipeline/bake_plan.hpp"
#include "papilla/pipeline/environment.hpp"
#include "papilla/pipeline/grain.hpp"
#include "papilla/pipeline/materials.hpp"
#include "papilla/pipeline/unwrap_scene.hpp"

namespace papilla {

/// Options of bake_scene().
struct BakeOptions {
  BakePlanOptions plan;
  /// Method, repair, layout and tile are set per surface by its material and plan. Its method's cache is that of the
  /// whole bake: sides, grains, uv and measures.
  UnwrapOptions unwrap;
  RecipeLibrary library = RecipeLibrary::builtin();  ///< What the rules' recipes may name.
  std::set<PartSlot> without_grain;                  ///< Surfaces of the plan that stay as they came.
  bool surface_maps = true;  ///< BakedSurface::mesh and its distortion per triangle, for write_bake_pictures().
};

/// A surface with grain, as it was baked.
struct BakedSurface {
  std::uint32_t part = 0, slot = 0;  ///< As in PartSurface.
  std::string label, material;
  std::string same_as;                   ///< In place: the label of the equal surface whose new uv these are; or empty.
  std::string method, reason;            ///< Of the unwrap; "kept" when its own uv stays.
  StopReason stop = StopReason::direct;  ///< Of the unwrap.
  std::uint32_t charts = 0;
  double seam_mm = 0;
  double grain_continued_mm = 0;  ///< Of the seam: where the grain goes on; 0 when its own uv stays.
  SeamVisibility seams;           ///< For the grain's tile, a grain being an eighth of it.
  std::vector<std::string> notes;
  std::optional<RepairResult> repaired;  ///< Without its mesh; when it was.
  DistortionReport distortion;           ///< Per triangle with BakeOptions::surface_maps.
  TriangleMesh mesh;         ///< The surface with uv in millimetres; empty without BakeOptions::surface_maps.
  CornerAttribute<Vec2> uv;  ///< In place: the new uv in repeats of the grain; empty when its own stay.
};

/// The picture of a material whose recipe reads position, normal or sky: of all its surfaces, where they stand.
struct BakedAtlas {
  std::string material;
  int width = 0, height = 0;
  std::size_t charts = 0;
  double mm_per_texel = 0;
};

struct BakeResult {
  BakePlan plan;  ///< Without its scene.
  Scene scene;    ///< With uv, textures and haptic tags; ready to be written. In place: as it was.
  std::map<std::string, Grain> grains;              ///< By material.
  std::map<std::string, std::string> environments;  ///< environment_json() by material, of those that name one.
  std::vector<BakedSurface> surfaces;               ///< Those with grain.
  std::vector<BakedAtlas> atlases;                  ///< Of recipes that read the surface.
  ObjectTextures object_textures;                   ///< Decals and carriers; empty in place.
  std::vector<Vec2> mm_per_uv;                      ///< Per material of `scene`; 0 when unknown.
  std::map<std::string, double> seconds;            ///< Per stage: summed over the surfaces.
};

/// total_repair() of the surfaces that were repaired.
RepairResult repair_of(const std::vector<BakedSurface>& surfaces);

/// The ending that promises least, of all surfaces, their repair and the search for a budget.
StopReason ending_of(const BakeResult& result);

/// The main job: plan_bake(), then for every surface what its plan says and nothing else. Surfaces run in parallel; the
/// result does not depend on the number of threads. A material whose recipe reads position, normal or sky gets an atlas
/// of the surfaces that show it, on which picture, relief and maps lie; in place it would be a tile.
/// @throws InvalidInput, IoError, SolverFailure naming the part or picture.
BakeResult bake_scene(Scene scene, const Materials& rules, const BakeOptions& options = {},
                      const ProgressCallback& progress = {});

/// Writes pictures of a bake into `folder`: the scene with its materials and with a checker, close-ups of every grain,
/// the uv layout of the largest surfaces, and the relief of every grain.
/// @return their names. @throws IoError when one can't be written.
/// @param environment  lights the scene; null: two lamps do.
std::vector<std::string> write_bake_pictures(const BakeResult& result, const std::filesystem::path& folder,
                                             std::shared_ptr<const EnvironmentLight> environment = nullptr,
                                             const ProgressCallback& progress = {});

}  // namespace papilla
