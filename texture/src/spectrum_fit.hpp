// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "surface_spectrum.hpp"

namespace papilla::texture_detail {

/// Which of the effects of a camera a fit has.
struct SpectrumModel {
  PointSpread spread = PointSpread::optical;
  bool blurred = false;  ///< σ is fitted, otherwise 0.
  bool noisy = false;    ///< White noise beyond that of the rounding is fitted.
};

/// Where frequencies count, in cycles per pixel.
struct SpectrumBand {
  double least = 0, most = 1;
  bool holds(const SpectrumCell& cell) const {
    const double f = cell.frequency_squared();
    return f >= least * least && f <= most * most;
  }
};

/// The most likely parameters of
///   P(f) = a S(f; H, σ) (1 + directions) + rounding noise + noise
/// by Whittle's likelihood of the periodogram.
struct SpectrumFit {
  SpectrumModel model;
  double amplitude = 0, hurst = 0.5, spread_squared = 0, noise = 0;
  std::array<double, 4> directions{};  ///< Of ln a by cos 2θ, sin 2θ, cos 4θ, sin 4θ.
  int parameters = 0;
  double misfit = 0;           ///< Twice the negative logarithm of the likelihood, that of a perfect fit taken away.
  double hurst_deviation = 0;  ///< Standard deviation of H by Fisher's information.
  std::vector<double> power;   ///< P of every cell and its mirror, two values a cell.
};

/// First parameters for fit_spectrum(): the best of a grid, by rings, without directions and aliases.
SpectrumFit scan_spectrum(std::span<const SpectrumCell> cells, const SpectrumModel& model, const SpectrumBand& band,
                          double rounding);

/// @param rounding  density of the rounding noise, q²/12.
/// @param start  parameters to begin with; when they are of a model without noise, the result has noise only where
/// that makes the fit better.
SpectrumFit fit_spectrum(std::span<const SpectrumCell> cells, const SurfaceSpectrumModel& surface,
                         const SpectrumModel& model, const SpectrumBand& band, double rounding,
                         const SpectrumFit& start);

}  // namespace papilla::texture_detail
