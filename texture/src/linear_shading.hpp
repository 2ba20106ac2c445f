// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "papilla/core/vec.hpp"
#include "papilla/texture/shape_from_shading.hpp"

namespace papilla::texture_detail {

/// ρ of a wave, radians per pixel of the picture along x and y: how much it is damped.
using WaveDamping = std::function<double(double, double)>;

/// Heights of R ≈ s_z − s_x p − s_y q in Fourier space,
///   Z = conj(D) I / (|D|² + ρ(ω) |ω|² |(s_x, s_y)|²),  D = −i (s_x ω_x + s_y ω_y).
/// A picture that does not tile is continued by its mean over a quarter of its sides. The trace holds the residual.
/// @pre the light is oblique() and the options are those of require_shading_options().
ShadingResult linear_shading(const GreyImage& image, const ShadingOptions& options, Vec3 light,
                             const WaveDamping& damping);
/// The same by pieces: the method is linear, so that the long waves come from the small picture and the others, which
/// reach less far, from pieces. The trace holds the root mean square over the pieces of their residuals.
ShadingResult linear_shading_by_rows(const SampleRows& image, const ShadingOptions& options, Vec3 light,
                                     const WaveDamping& damping, const HeightWriter& write);

}  // namespace papilla::texture_detail
