// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "papilla/haptic/height_field.hpp"
#include "papilla/haptic/material_tag.hpp"

namespace papilla {

/// A relief synthesised from its statistics, for a material whose height map is lost: a periodic sum of 96 waves
///     h(x) = Σ a_j cos(2π k_j·x + φ_j),  a_j ∝ |k_j|^−H,  H = 3 − D, or ½ where no dimension is stated,
/// with directions and phases from `seed` and |k| evenly distributed in log between the two wavelengths, so that the
/// mean square of a difference over a distance r grows as r^2H (spectral synthesis; profiles have the spectrum
/// k^−(2H+1)), scaled to the root mean square height. Waves are stretched along `direction` by the square root of the
/// anisotropy and shortened across it by the same. Wave numbers are rounded to those that the tile holds. The tile
/// measures the longest wavelength and has 256² samples, so wavelengths below 4 samples are left out. Deterministic for
/// a given seed. Cost: about 0.1 s.
/// @param metres_per_uv length of a unit of untransformed uv, > 0.
/// @throws InvalidInput when a number is not finite or a length not > 0.
HeightField roughness_field(const RoughnessTag& roughness, Vec2 metres_per_uv, std::uint64_t seed);

/// The relief with roughness laid over it: the same sum of waves with the whole relief as tile, so that both repeat
/// together. The relief gets as many samples as the shortest wavelength needs, 4, up to 2048 a side; shorter waves are
/// left out, and so are those longer than the relief. A relief without area in uv stays as it is. Cost: about 0.1 µs
/// for a sample of the result and wave.
/// @param metres_per_uv as above. @throws InvalidInput as above.
HeightField with_roughness(const HeightField& relief, const RoughnessTag& roughness, Vec2 metres_per_uv,
                           std::uint64_t seed);

}  // namespace papilla
