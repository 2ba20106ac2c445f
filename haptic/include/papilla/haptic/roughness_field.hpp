// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "papilla/haptic/height_field.hpp"
#include "papilla/haptic/material_tag.hpp"

namespace papilla {

/// A relief synthesised from its statistics, for a material whose height map is lost: a periodic sum of 96 waves
///     h(x) = Σ a_k cos(2π k·x/L + φ_k),  a_k ∝ |k|^−(H + 1/2),  H = 3 − D,
/// with directions and phases from `seed` and |k| evenly distributed in log between the two wavelengths (spectral
/// synthesis; profiles of dimension D − 1 have the spectrum k^−(2H+1)), scaled to the root mean square height. L is the
/// longest wavelength; the tile has 256² samples, so wavelengths below 4 samples are left out. Deterministic for a
/// given seed. Cost: about 0.1 s.
/// @param metres_per_uv length of a unit of untransformed uv, > 0; the tile is L × L on the surface.
/// @throws InvalidInput when a number is not finite or a length not > 0.
HeightField roughness_field(const RoughnessTag& roughness, Vec2 metres_per_uv, std::uint64_t seed);

}  // namespace papilla
