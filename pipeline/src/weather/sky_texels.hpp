// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "papilla/meshing/sky.hpp"
#include "weather/surface_texels.hpp"

namespace papilla {

/// What hides the sky in a scene: all its parts, as they stand, y up.
SkyView sky_of(const Scene& scene, std::span<const Instance> all, int rays);

/// The sky at every covered texel, 0 at the others. Rays are cast for one texel of each block of 8 x 8 and
/// interpolated between the blocks of the window. Cost: rays / 64 sight lines a texel, all cores.
std::vector<float> sky_texels(const SurfaceTexels& texels, const SkyView& sky);

}  // namespace papilla
