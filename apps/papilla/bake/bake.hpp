// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bake/grain_material.hpp"
#include "bake/surfaces.hpp"
#include "papilla/core/progress.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/param/measure.hpp"

namespace papilla::app {

struct BakedSurface {
  std::uint32_t part = 0;
  std::string label, material;
  std::string method, reason;  ///< Of the unwrap; "kept" when its own uv stays.
  std::uint32_t charts = 0;
  double seam_mm = 0;
  double grain_continued_mm = 0;  ///< Of the seam: where the grain goes on.
  std::vector<std::string> notes;
  DistortionReport distortion;
  TriangleMesh mesh;  ///< The surface with uv in millimetres, for pictures.
};

struct BakeResult {
  Scene scene;                            ///< With uv, textures and haptic tags; ready to be written.
  std::map<std::string, Grain> grains;    ///< By rule.
  std::vector<BakedSurface> surfaces;     ///< Those with grain.
  std::vector<Vec2> mm_per_uv;            ///< Per material of `scene`; 0 when unknown.
  std::map<std::string, double> seconds;  ///< Per stage.
};

/// Does for every surface what its plan says, and nothing else.
/// Surfaces are independent and run in parallel; the result does not depend on the number of threads.
/// @throws InvalidInput, IoError, SolverFailure naming the part or picture.
/// @param library  what the rules' recipes may name.
BakeResult bake(Scene scene, const std::vector<Surface>& surfaces, const ProgressCallback& progress,
                const RecipeLibrary& library = RecipeLibrary::builtin());

}  // namespace papilla::app
