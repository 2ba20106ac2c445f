// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/texture/image.hpp"

namespace papilla::texture_detail {

/// H of a surface that is seen sharp and without noise but for its rounding to whole steps of q, from the variance of
/// second differences,
///   v(k) = ⟨(z(x + k e) − 2 z(x) + z(x − k e))²⟩ ∝ k^(2H),
/// along rows, columns and both diagonals, ½q² of rounding taken away. They ignore tilt and bend and are nearly
/// independent from place to place. Lags 1 and 2; where rounding is more than a tenth of the first lag, all lags up to
/// 2, 4, … 32, whichever range rises above half of the rounding and varies least from block to block, with weights
/// k⁻²·(v_corrected / v_raw)². Outside (0, 1) where the picture is not such a surface. Cost: O(pixels) a lag.
/// @pre at least 32 pixels a side, not flat.
/// Istas and Lang, Quadratic variations and estimation of the local Hölder index, 1997.
double sharp_hurst(const GreyImage& image, double quantization_step);

}  // namespace papilla::texture_detail
