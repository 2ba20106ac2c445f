// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "weather/own_surface.hpp"
#include "weather/surface_atlas.hpp"

namespace papilla {

/// All that painting a material needs to know of the scene; the same at any time and for any recipe with this reading.
struct MaterialSurface {
  std::vector<SurfaceTriangle> triangles;
  double mm_per_repeat = 0;  ///< 0: nothing with uv shows the material, and nothing else is known.
  std::optional<OwnSurface> own;
  std::optional<SurfaceTexels> repeat;  ///< One repeat, where no texel is shown by two unlike places.
  std::vector<float> sky;               ///< Of `repeat`; empty when it is not read.
  SurfaceAtlas atlas;                   ///< Else.
  bool leaves_the_repeat() const;       ///< Some uv lie outside of [0, 1].
  std::size_t texels() const;
};

/// @param size  texels a repeat. @param sky  is called if the reading asks for it.
MaterialSurface lay_out(const Scene& scene, std::span<const Instance> all, std::uint32_t material, int size,
                        const SurfaceReading& reading, const std::function<const SkyView&()>& sky);

}  // namespace papilla
