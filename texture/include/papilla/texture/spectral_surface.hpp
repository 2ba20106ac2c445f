// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "papilla/core/progress.hpp"
#include "papilla/texture/height_grid.hpp"

namespace papilla {

/// Options of spectral_surface().
struct SpectralSurfaceOptions {
  int size = 256;                      ///< Samples a side, 2 to 8192.
  double hurst = 0.7;                  ///< H in (0, 1).
  double shortest_wavelength_px = 2;   ///< Waves shorter than this are left out; at least 2.
  double longest_wavelength_px = 1e9;  ///< Waves longer than this are left out.
  std::uint64_t seed = 1;
  std::optional<double> hurst_across = {};  ///< H across `angle_deg`; `hurst` then is that along it.
  double angle_deg = 0;                     ///< From x (right) towards y (down).
  ProgressCallback progress = {};
};

/// Periodic Gaussian surface with spectral density ∝ |k|^(−2H−2) between the two wavelengths and rms height 1:
/// tiles exactly. It approaches dimension 3 − H over the wavelengths present, but it is smoother than a
/// fractional Brownian surface at pixel scale (no aliased power): take brownian_surface_exact() as ground truth.
/// With hurst_across H depends on the direction of the wave, as the radius of an ellipse with these half axes.
/// Cost: two FFTs. Deterministic for a seed.
/// @throws InvalidInput when an option is out of range or no wave lies within the two wavelengths.
/// Saupe in The Science of Fractal Images, 1988.
HeightGrid spectral_surface(const SpectralSurfaceOptions& options);

}  // namespace papilla
