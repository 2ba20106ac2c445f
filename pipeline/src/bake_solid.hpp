// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/pipeline/grain.hpp"
#include "papilla/pipeline/materials.hpp"

namespace papilla {

/// A material of a scene that is shown by a recipe that reads the surface (Grain::solid).
struct SolidUse {
  std::uint32_t material = 0;
  const MaterialRule* rule = nullptr;
  const Grain* tile = nullptr;  ///< Of the rule; the material's normal map is its own, at the coordinates of repeats.
};

struct SolidGrain {
  Grain grain;
  bool repeats = false;    ///< One repeat at the coordinates that there are; else an atlas on channel 0.
  std::size_t charts = 0;  ///< Of the atlas.
};

/// Texels of an atlas a side at most.
inline constexpr int k_solid_atlas_side = 2048;
/// By which what hides the sky of a texel is found.
inline constexpr int k_solid_sky_rays = 64;

/// Paints the recipes on the surfaces that show the materials, where they stand in the scene, and gives the scene the
/// coordinates of the atlases; those that there were move to channel 1.
/// @return one for each use. @throws InvalidInput as compile_texture() and cut_surface().
std::vector<SolidGrain> paint_solid(Scene& scene, std::span<const SolidUse> uses, const RecipeLibrary& library,
                                    const ProgressCallback& progress);

}  // namespace papilla
