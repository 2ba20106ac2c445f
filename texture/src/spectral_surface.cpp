// SPDX-License-Identifier: MIT
#include "papilla/texture/spectral_surface.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "papilla/core/error.hpp"
#include "papilla/core/units.hpp"
#include "shaped_noise.hpp"

namespace papilla {
namespace {

/// H of waves along a direction: the radius of the ellipse with the half axes `hurst` along `angle` and `hurst_across`.
double directional_hurst(const SpectralSurfaceOptions& options, double x, double y) {
  if (!options.hurst_across) return options.hurst;
  const double turned = std::atan2(y, x) - options.angle_deg * k_radians_per_degree;
  const double along = options.hurst, across = *options.hurst_across;
  return along * across / std::hypot(along * std::sin(turned), across * std::cos(turned));
}

void require(const SpectralSurfaceOptions& options) {
  const auto fits = [](double hurst) { return hurst > 0 && hurst < 1; };
  if (options.size < 2 || options.size > 8192)
    throw InvalidInput("spectral_surface: size " + std::to_string(options.size) + " is not within 2 to 8192");
  for (const double hurst : {options.hurst, options.hurst_across.value_or(options.hurst)})
    if (!fits(hurst)) throw InvalidInput("spectral_surface: hurst " + std::to_string(hurst) + " is not within (0, 1)");
  if (!std::isfinite(options.angle_deg)) throw InvalidInput("spectral_surface: the angle is not finite");
}

}  // namespace

HeightGrid spectral_surface(const SpectralSurfaceOptions& options) {
  require(options);
  const int n = options.size;
  const auto gain = [&](double x, double y) {
    const double waves = n * std::hypot(x, y), wavelength = waves > 0 ? n / waves : 0;
    if (!(waves > 0) || wavelength < options.shortest_wavelength_px || wavelength > options.longest_wavelength_px)
      return 0.0;
    return std::pow(waves, -directional_hurst(options, x, y) - 1);
  };
  HeightGrid surface{n, adopted_values(texture_detail::shaped_noise(n, n, options.seed, gain, options.progress)), true};
  if (std::all_of(surface.heights.begin(), surface.heights.end(), [](double h) { return h == 0; }))
    throw InvalidInput("spectral_surface: no wave of a " + std::to_string(n) + " pixel surface is between " +
                       std::to_string(options.shortest_wavelength_px) + " and " +
                       std::to_string(options.longest_wavelength_px) + " pixels long");
  return surface;
}

GreyImage to_grey_image(const HeightGrid& surface, int bits) {
  if (surface.heights.empty()) throw InvalidInput("to_grey_image: the surface is empty");
  if (bits != 8 && bits != 16 && bits != 32)
    throw InvalidInput("to_grey_image: bits " + std::to_string(bits) + " is not 8, 16 or 32");
  GreyImage image{surface.size, surface.size, Values<float>(surface.heights.size()), 0, bits};
  const auto [low, high] = std::minmax_element(surface.heights.begin(), surface.heights.end());
  const double offset = *low, range = *high - *low, steps = bits == 8 ? 255 : 65535;
  std::transform(surface.heights.begin(), surface.heights.end(), image.pixels.begin(), [&](double height) {
    const double grey = range > 0 ? (height - offset) / range : 0;
    return static_cast<float>(bits == 32 ? grey : std::round(steps * grey) / steps);
  });
  return image;
}

}  // namespace papilla
