// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "papilla/texture/fractal.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// What best_dimension() returns.
struct BestDimension {
  /// The dimension, in [2, 3] with its interval; empty where no power law holds. The curve is `curve`.
  std::optional<FractalEstimate> estimate;
  std::string reason;             ///< Why a power law holds, or why none does.
  std::vector<ScalePoint> curve;  ///< Lag and root mean square second difference of the picture as it is.
  /// Hurst exponents of the waves along 0°, 90°, 45° and −45° (rows, columns, the diagonal down right, the one up
  /// right), within 22.5°; empty without a law, and where few waves are that long.
  std::optional<std::array<double, 4>> directional_hurst;
  /// Wavelengths in pixels over which the law is seen: from where the point spread halves the power or the noise equals
  /// it, at least 2, to the longest that was fitted. 0 without a law.
  double least_scale_px = 0, most_scale_px = 0;
  double psf_sigma_px = 0;       ///< Standard deviation of the Gaussian point spread found, 0 for none.
  double noise_rms = 0;          ///< Of the white noise found, rounding included, in grey values (or heights).
  double chi2_per_dof = 0;       ///< Misfit of the spectrum by rings over what chance makes; 1 is perfect.
  double quantization_step = 0;  ///< Grey step of the picture's rounding, 0 for none.

  bool power_law() const noexcept { return estimate.has_value(); }
};

/// Fractal dimension D = 3 − H of a self-affine surface seen through a camera. The model of the power spectrum at the
/// frequency f (cycles per pixel) is
///   P(f) = a Σ_m |f + m|^(−2H−2) T(f + m)² + q²/12 + n,
/// the sum over all frequencies that look alike on the grid, T the transfer of a Gaussian point spread of σ pixels, q
/// the step of the rounding and n white noise; a may depend on the direction by cos 2θ … sin 4θ. a, H, σ, n are
/// fitted to the periodogram by Whittle's likelihood (Ceres), for the surface sharp or blurred, without or with noise,
/// and five kinds of point spread (optical, optical on square pixels, a kernel on the grid, a filter on the grid, a
/// limited band). The dimension is the mean over these fits, each weighted by its likelihood and an information
/// criterion; the 95 % interval is that of their mixture, widened where the misfit is more than chance.
/// There is no dimension, and `reason` says why, where the picture is flat, smooth at the scale of a pixel (H at 1, or
/// a point spread beyond 2.5 pixels), periodic (a tenth of its power in single frequencies), level towards long waves,
/// too uncertain, or no power law over the wavelengths that it holds. Accuracy (rms error of D on exact surfaces, D
/// = 2.1…2.9): docs/methods/best-dimension.md. Tilt and bend do not matter. Cost: one transform and about 30 ms for the
/// fits. Deterministic.
/// @param image at least 32 pixels a side, `bits` the rounding of its values.
/// @param longest_wave_px longer waves are left out, as where a relief of another kind is below the roughness.
/// @throws InvalidInput when the picture is smaller, empty or not finite.
/// Whittle, On stationary processes in the plane, 1954; Schwarz, Estimating the dimension of a model, 1978.
BestDimension best_dimension(const GreyImage& image, double longest_wave_px = 1e300);

}  // namespace papilla
