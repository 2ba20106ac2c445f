// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "papilla/io/haptic_scene.hpp"
#include "papilla/pipeline/studio/studio_scene.hpp"

namespace papilla {

/// A surface at one of its places.
struct FeltSurface {
  std::shared_ptr<const StudioSurface> surface;
  Transform world = k_identity;
};

/// Those that hands feel, as their material has a haptic tag, and whose box comes within `reach_mm` of a point, in
/// their order. Cost: O(vertices).
std::vector<FeltSurface> felt_surfaces(const std::vector<FeltSurface>& surfaces, Vec3 point_mm, double reach_mm);

/// haptic_scene() of surfaces in the frame of the studio's scene: what a player loads of the baked file, whose vertices
/// are rounded to single precision as these are.
/// @param force_model a name of force_model() that takes the place of that of every tag, whose amplitude, sign, level
/// and, where the model has it, form stay; empty: as the tags say.
/// @param path stands for the file in messages, and finds what tags name beside it.
/// @throws InvalidInput when there is nothing to feel, or no such model.
HapticScene felt_scene(const std::vector<FeltSurface>& surfaces, const std::string& force_model,
                       const std::filesystem::path& path, const HapticSceneOptions& options);

}  // namespace papilla
