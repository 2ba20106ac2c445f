// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "papilla/texture/fractal.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// Hurst exponent along one direction.
struct DirectionalHurst {
  double angle_deg = 0;  ///< From x (right) towards y (down), in [0, 180).
  double hurst = 1;
  double low = 1, high = 1;  ///< 95 % jackknife over 16 blocks of the picture.
};

/// Fractal signature of a surface in all directions; see fshot_dimension().
struct FshotSignature {
  double sta = 1;        ///< Semi-minor axis of the ellipse: Hurst exponent of the roughest direction.
  double str = 1;        ///< Minor axis over major axis: 1 for a surface without direction.
  double angle_deg = 0;  ///< Direction of the minor axis, from x (right) towards y (down), in [0, 180).
  double fs_h = 2;       ///< Dimension along rows: 3 − the ellipse's radius at 0°.
  double fs_v = 2;       ///< Dimension along columns: 3 − the ellipse's radius at 90°.
  std::vector<DirectionalHurst> directions;  ///< By rising angle: the points of the polar plot.
  /// Dimension 3 − sta with its 95 % jackknife interval; the curve holds the distance and the mean over the
  /// directions of the largest step.
  FractalEstimate estimate;
};

/// Fractal signature of the Hurst orientation transform: for every direction (in steps of 2°) and every distance
/// r = 1…16 pixels on that direction the largest |z(x) − z(x + r e)| over the whole picture; the slope of its logarithm
/// over log r is the Hurst exponent H of that direction. An ellipse A x² + B x y + C y² = 1 is fitted to the points
/// (H cos φ, H sin φ). With the full axes a ≤ b and the direction θ of the minor one,
///   Sta = a/2,  Str = a/b,  FS_H = 3 − ½ a b / √((a sin θ)² + (b cos θ)²),  FS_V with sine and cosine exchanged.
/// The factor ½ is missing in the paper, whose Sta uses half axes.
/// Only directions that hold at least five distances count. The largest step is not a scaling estimator of
/// the mean: on exact fractional Brownian surfaces H = 0.9, 0.6, 0.3 gives a mean radius of about 0.85, 0.55, 0.26, and
/// the minor axis lies below that. A signature to compare with published ones; best_dimension() is the estimator.
/// Good input: 257 pixels a side or more. Grey values need no scale. A flat picture is a plane: H = 1.
/// Cost: about 400 operations a pixel. Deterministic.
/// @param image at least 32 pixels a side, all values finite.
/// @throws InvalidInput when the picture is smaller, empty or not finite.
/// Podsiadlo and Stachowiak, Fractal signatures by Hurst orientation transform, 2000; Cho et al., Haptic
/// cushion/fractal textures, 2017.
FshotSignature fshot_dimension(const GreyImage& image);

/// The signature of a surface known by pieces: in every direction that all pieces have the mean of their Hurst
/// exponents, with the 95 % interval of that mean, and the ellipse through those; the interval of the dimension is that
/// of the pieces' mean, the curve their geometric mean. One piece gives itself.
/// @pre at least one piece.
FshotSignature mean_signature(std::span<const FshotSignature> pieces);

}  // namespace papilla
