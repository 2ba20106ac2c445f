// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/texture/image.hpp"

namespace papilla::texture_detail {

/// The picture under even light: grey ← mean + (grey − Q) · deviation / D, Q the quadric in x, y that fits the greys
/// best and D² the one that fits (grey − Q)² best, D at least a quarter of the mean deviation. Takes away the fall-off
/// of a light and of a lens, offset and gain apart, and leaves a flat picture as it is. Cost: O(pixels).
GreyImage with_even_light(const GreyImage& image);

/// Grey minus its mean over a Gaussian of `deviation_px`, over the deviation there (at least a fifth of the picture's);
/// mean about 0 and rms about 1. Cost: four Fourier transforms.
std::vector<double> locally_normalized(const GreyImage& image, double deviation_px);

}  // namespace papilla::texture_detail
