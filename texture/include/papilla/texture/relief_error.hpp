// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/texture/height_map.hpp"

namespace papilla {

/// How far a reconstructed relief is from the true one.
struct ReliefError {
  double mean = 0;         ///< Mean |difference| over the range of the truth, the best plane taken from the difference.
  double scaled_mean = 0;  ///< The same after the found heights were scaled to fit best.
  /// Rms difference of the slopes over the rms slope of the truth, heights scaled to fit best.
  double slope = 0;
  double correlation = 0;  ///< Of the heights, best planes taken from both; 0 when one of them is flat.
};

/// Compares heights in pixels with a relief in millimetres of the same size, whose pixels are square.
/// Cost: O(samples). @throws InvalidInput when the sizes differ, a value is not finite, the truth is flat, or its pitch
/// is not positive. Zhang, Tsai, Cryer and Shah, Shape from shading: a survey, 1999 (the depth error).
ReliefError relief_error(const std::vector<double>& found_px, const HeightMap& truth);

}  // namespace papilla
