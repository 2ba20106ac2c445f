// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "grain_maker.hpp"
#include "papilla/pipeline/bake_file.hpp"
#include "papilla/pipeline/bake_scene.hpp"
#include "surface_bake.hpp"

namespace papilla {

/// A surface on its way through the stages.
struct SurfaceWork {
  const PartSurface* surface = nullptr;
  const MaterialRule* rule = nullptr;
  SurfaceOutput output;
  const SurfaceWork* equal_to = nullptr;  ///< In place: an earlier one of the same mesh and rule; gets uv for both.
};

/// What comes before the surfaces are baked.
struct PreparedBake {
  BakeResult result;               ///< Plan, scene and grains.
  std::vector<SurfaceWork> works;  ///< Their pointers lead into the plan and the rules.
  PartContext context;             ///< Of all parts.
  UnwrapOptions unwrap;            ///< Of all surfaces.

  SurfaceInput input_of(const SurfaceWork& work) const;
};

/// Of which a scene is a piece.
struct WholeScene {
  PartContext context;
  bool keeps_triangles = false;  ///< It is edited in place: nothing is repaired.
};

/// The first half of bake_scene(): plan_bake() and the grains.
/// @param whole null: the scene is no piece.
PreparedBake prepare_bake(Scene scene, const Materials& rules, const BakeOptions& options, GrainMaker& maker,
                          const ProgressCallback& progress, const WholeScene* whole = nullptr);

/// bake_scene() with grains that may have been begun, of a scene that may be a piece of another.
BakeResult bake_scene(Scene scene, const Materials& rules, const BakeOptions& options, GrainMaker& maker,
                      const ProgressCallback& progress, const WholeScene* whole = nullptr);

/// The same of a file, as bake_file() would read it.
PreparedBake prepare_file(const std::filesystem::path& input, const Materials& rules, const BakeFileOptions& options,
                          BakeWay& way, const ProgressCallback& progress);

}  // namespace papilla
