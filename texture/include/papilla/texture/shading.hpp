// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/core/vec.hpp"
#include "papilla/texture/height_map.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// Lambertian picture of a relief: grey = max(0, n·light), with the slopes in millimetres per millimetre by central
/// differences (one-sided at the borders of a relief that is not periodic). No cast shadows. Frame: x right,
/// y down, z towards the viewer. The picture has the pitch of the relief when that is the same in x and y.
/// Cost: O(samples).
/// @throws InvalidInput when the relief is empty, not finite or without pitch, or the light does not come from the
/// front.
GreyImage render_lambert(const HeightMap& relief, Vec3 light);

}  // namespace papilla
