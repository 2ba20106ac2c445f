// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// Mean squared distortion of a picture against itself for every shift; see feature_matrix().
struct FeatureMatrix {
  int reach_x = 0, reach_y = 0;    ///< Shifts run from −reach to +reach.
  std::vector<double> distortion;  ///< Row by row, (2·reach_x+1) · (2·reach_y+1) values, in grey².

  int width() const { return 2 * reach_x + 1; }
  int height() const { return 2 * reach_y + 1; }
  double at(int dx, int dy) const {
    return distortion[static_cast<std::size_t>(dy + reach_y) * static_cast<std::size_t>(width()) +
                      static_cast<std::size_t>(dx + reach_x)];
  }
};

/// Statistical Feature Matrix: for every shift t within ±⌊w/2⌋, ±⌊h/2⌋
///   d²(t) = (1/n(t)) Σ_x (I(x) − I(x + t))²  over the n(t) pixels of the overlap,
/// computed as [S_A(t) + S_B(t) − 2 R(t)] / n(t): S from a summed-area table of the squares over the two
/// overlaps, R the autocorrelation by one pair of zero-padded FFTs. d²(0) = 0, d²(−t) = d²(t).
/// Grey values as in the picture (in [0, 1] for pictures). Pictures with 8 bits give the exact value
/// of the direct sum, because its numerator in grey steps is an integer and the FFT's error is below ½;
/// others agree with it to 1e-9 of the picture's variance.
/// Cost: two FFTs of (3w/2) × (3h/2), about 25 ms for 1024². Deterministic.
/// @throws InvalidInput when the picture is empty or not finite.
/// Wu and Chen, Statistical feature matrix for texture analysis, 1992; Schulze 2005, definitions 7.3 to 7.7.
FeatureMatrix feature_matrix(const GreyImage& image);

/// The same with the absolute distortion that the source's displayed definition has,
///   d(t) = (1/n(t)) Σ_x |I(x) − I(x + t)|,  in grey values,
/// a direct sum: no transform gives it. Exact for 8-bit pictures (sums of whole steps).
/// Cost: O(pixels²): about 0.1 s at 256², 20 s at 1024², shared by the threads. Independent of their number.
/// @throws InvalidInput as feature_matrix(), and for pictures over 2048 pixels a side.
FeatureMatrix absolute_feature_matrix(const GreyImage& image, const ProgressCallback& progress = {});

}  // namespace papilla
