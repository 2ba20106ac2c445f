// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/texture/fractal.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// The three box measures of the grey picture read as a point set {(x, y, g)}, with g stretched to
/// 0…255 and rounded and one grey level as high as one pixel is wide. Boxes are cubes of side s:
///   box_dimension          N(s) = number of occupied boxes                 s = 8, 16, 32, 64
///   information_dimension  log N(s) = −Σ p log p, p = share of the points  s = 4, 6, 8, 12, 16, 24
///   correlation_dimension  N(s) = 1 / Σ p²                                 s = 4, 6, 8, 12, 16, 24
/// D is the negative slope of log N over log s. Where s does not divide the picture's sides, the
/// centred part that it divides is counted and N is scaled up by the area left out.
///
/// Point-set boxes saturate: each column of boxes holds at most s² points, so D is underestimated the
/// more the rougher the surface is. On exact fractional Brownian surfaces (brownian_surface_exact)
/// D = 2.2, 2.5, 2.8 is read as about 2.11, 2.30, 2.53 by the box and 2.12, 2.33, 2.46 by the information
/// and the correlation dimension. These readings exist to compare with published tables; best_dimension is the
/// estimator.
///
/// Good input: at least 256 pixels a side. Cost: O(pixels) a scale. Deterministic.
/// The interval is that of the regression; it covers the scatter of the points, not the bias.
/// @param image at least 32 pixels a side, all values finite; scales above the shorter side are left out.
/// @throws InvalidInput when the picture is smaller, empty or not finite.
/// Schulze, Haptische Texturen, 2005, chapter 6; Reuter, 2003.
FractalEstimate box_dimension(const GreyImage& image);
FractalEstimate information_dimension(const GreyImage& image);  ///< See box_dimension().
FractalEstimate correlation_dimension(const GreyImage& image);  ///< See box_dimension().

}  // namespace papilla
