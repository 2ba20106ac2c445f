// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "papilla/core/vec.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// The part of a picture that repeats with a lattice, and what is left; see symmetric_part().
struct SymmetricPart {
  /// One cell: sample (i, j) is the mean grey at (i/width)·a + (j/height)·b plus every lattice vector, measured
  /// from the centre of the picture's first pixel. Neighbours wrap around in both directions.
  GreyImage primitive;
  GreyImage synthesis;  ///< The picture's size, from the primitive and the lattice.
  GreyImage residual;   ///< Picture minus synthesis, signed.
  int cells = 0;        ///< Area of the picture in cells, rounded down.
  /// 1 − (Σ residual² / (pixels − samples of the primitive)) / variance, in [0, 1]: the number of
  /// samples fitted is paid for, so that a lattice put on noise explains 0.
  double explained_variance = 0;
};

/// Averages all lattice cells of a picture (bicubic, sub-pixel vectors), and synthesizes the symmetric part from that.
/// The mean of the cells is the least squares primitive; noise falls with the number of cells.
/// Cost: O(pixels). Deterministic.
/// @param vectors_px two independent lattice vectors (x right, y down), shorter than the picture's sides.
/// @throws InvalidInput when the picture is empty or not finite, or the vectors are parallel, shorter than
///         2 pixels or longer than the picture.
/// Schulze 2005, section 7.2 and figure 7.7.
SymmetricPart symmetric_part(const GreyImage& image, const std::array<Vec2, 2>& vectors_px);

}  // namespace papilla
