// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// What register_photographs() returns.
struct Registration {
  /// The photographs moved onto the first one; pixels from beyond a border repeat the border's.
  std::vector<GreyImage> photographs;
  std::vector<Vec2> shifts_px;  ///< Content of a photograph lies so far right of and below that of the first one.
  double disagreement_px = 0;   ///< Robust deviation of the shifts between pairs from those of the photographs.
};

/// Finds how far photographs of one place under different light are moved against each other.
/// Light from another side makes of a wave of the relief the same wave, stronger, weaker or inverted: the cross
/// spectrum of two photographs is C(ω) = (s_1·ω)(s_2·ω) |Z(ω)|² e^{−iωd}. Its square does not know the signs: the
/// phases of C² are those of a shift by 2d, whose correlation peak is found to a part of a pixel by a parabola. The
/// shifts of all pairs are reconciled by reweighted least squares. Pixels are interpolated by bicubic splines [Catmull
/// and Rom 1974]. Not modelled: rotation, scale and perspective; a turn by 0.1 degree moves the corners of 2000 pixels
/// by 2. Guarantees: shifts are bounded by `largest_shift_px`. A periodic relief is known up to its period. Cost: one
/// FFT a photograph and one a pair. Deterministic.
/// @param largest_shift_px  1 to a quarter of the shorter side; cut to that.
/// @throws InvalidInput when there is no photograph, their sizes differ, they are below 16 pixels a side or not finite,
///         or the largest shift is below 1.
/// Kuglin and Hines, The phase correlation image alignment method, 1975 (of the spectrum itself).
Registration register_photographs(const std::vector<GreyImage>& photographs, int largest_shift_px = 24);

}  // namespace papilla
