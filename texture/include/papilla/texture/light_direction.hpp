// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/core/vec.hpp"
#include "papilla/texture/image.hpp"
#include "papilla/texture/sample_rows.hpp"

namespace papilla {

/// What estimate_light() reads from a picture and what it has to assume.
struct LightEstimate {
  Vec3 direction{0, -0.7071067811865476, 0.7071067811865476};  ///< Length 1, x right, y down, z to the viewer.
  /// (λ1 − λ2)/(λ1 + λ2) of the structure tensor: 0.5 for an isotropic relief under oblique light, near 0 when the
  /// picture shows no light direction (frontal light, a height picture), 1 for stripes.
  double coherence = 0;
  double elevation_deg = 45;  ///< Assumed, not measured: one picture of unknown albedo does not determine it.
};

/// Light direction of a picture of a relief from its texture. For an isotropic relief the grey gradient is strongest
/// along the azimuth of the light, so the azimuth is the principal axis of the structure tensor ⟨∇I ∇Iᵀ⟩.
/// Assumed, because a picture does not determine it: the relief is isotropic; the light comes from above the picture
/// (of the two opposite azimuths the one with y < 0, from the left when horizontal); its elevation is 45°. Cost:
/// O(pixels). Deterministic. A flat picture gives light from above with coherence 0.
/// @throws InvalidInput when the picture is empty or not finite.
/// Koenderink and Pont, Irradiation direction from texture, J. Opt. Soc. Am. A 20(10), 2003.
LightEstimate estimate_light(const GreyImage& image);
/// The same of finite samples, in one pass.
LightEstimate estimate_light(const SampleRows& picture);

}  // namespace papilla
