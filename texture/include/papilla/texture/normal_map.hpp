// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/texture/height_map.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// Tangent-space normal map of a relief as glTF 2.0 wants it for `normalTexture`:
///   n = (−∂h/∂x, +∂h/∂y, 1) / |…|,  x right, y down the rows,
/// red = X to the right, green = Y up the picture (towards smaller v, as the v of glTF grows downwards), blue = Z out
/// of the surface; byte = round(255 · (n + 1)/2), so a flat surface is (128, 128, 255). The slopes are the
/// physical ones (millimetres per millimetre), so the shading shows exactly the relief that is felt, as long as the
/// texture is mapped at the relief's pitch and `scale` of the normalTexture is 1. Central differences,
/// around the seam when the relief is periodic.
/// Cost: O(samples). Deterministic.
/// @throws InvalidInput when the relief is empty, not finite or without pitch.
/// glTF 2.0 specification, section 3.9.3.
ColorImage normal_map(const HeightMap& relief);

}  // namespace papilla
