// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/texture/height_map.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// The periodic relief whose normal_map() comes closest to a tangent-space normal map of glTF:
///   min over h of Σ |D h − g|² + λ Σ (L h)²,  g = (−X/Z, Y/Z) · scale,
/// D the central differences of normal_map(), L the sum of second differences times the pitch, λ = 0.003; solved in
/// Fourier space. The second term keeps waves of two texels out, which central differences do not see; waves of four
/// texels lose 1 %. Mean 0 mm. The inverse of normal_map() for periodic reliefs up to that and the rounding to bytes;
/// slopes that belong to no relief are left out. Slopes over 20, and texels that look inwards, are taken as of
/// length 20. Cost: three FFT. Deterministic.
/// @param scale  of the normalTexture. @param pitch_mm_x,pitch_mm_y  of a texel, positive.
/// @throws InvalidInput when the map is empty or a number is out of range.
/// Frankot and Chellappa, A method for enforcing integrability in shape from shading algorithms, 1988.
HeightMap relief_of_normals(const ColorImage& map, double scale, double pitch_mm_x, double pitch_mm_y);

}  // namespace papilla
