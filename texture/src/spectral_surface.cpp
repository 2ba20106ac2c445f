// SPDX-License-Identifier: GPL-3.0-or-later
#include "papilla/texture/spectral_surface.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "checks.hpp"
#include "fft.hpp"
#include "papilla/core/error.hpp"
#include "random.hpp"

namespace papilla {

Surface spectral_surface(const SpectralSurfaceOptions& options) {
  const int n = options.size;
  if (n < 2 || n > 8192) throw InvalidInput("spectral_surface: size " + std::to_string(n) + " is not within 2 to 8192");
  if (!(options.hurst > 0 && options.hurst < 1))
    throw InvalidInput("spectral_surface: hurst " + std::to_string(options.hurst) + " is not within (0, 1)");

  texture_detail::RealFft2d fft(n, n);
  texture_detail::Random random(options.seed);
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) fft.real(x, y) = random.normal();
  fft.forward();
  for (int v = 0; v < n; ++v)
    for (std::size_t u = 0; u < fft.spectrum_width(); ++u) {
      const double waves = std::hypot(static_cast<double>(u), std::min(v, n - v));
      const double wavelength = waves > 0 ? n / waves : 0;
      const bool kept =
          waves > 0 && wavelength >= options.shortest_wavelength_px && wavelength <= options.longest_wavelength_px;
      fft.spectrum()[static_cast<std::size_t>(v) * fft.spectrum_width() + u] *=
          kept ? std::pow(waves, -options.hurst - 1) : 0;
    }
  fft.backward();

  Surface surface{n, std::vector<double>(static_cast<std::size_t>(n) * static_cast<std::size_t>(n)), true};
  double squares = 0;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) squares += fft.real(x, y) * fft.real(x, y);
  if (!(squares > 0))
    throw InvalidInput("spectral_surface: no wave of a " + std::to_string(n) + " pixel surface is between " +
                       std::to_string(options.shortest_wavelength_px) + " and " +
                       std::to_string(options.longest_wavelength_px) + " pixels long");
  const double scale = n / std::sqrt(squares);
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) surface.heights[texture_detail::pixel_index(x, y, n)] = scale * fft.real(x, y);
  return surface;
}

GreyImage to_grey_image(const Surface& surface, int bits) {
  if (surface.heights.empty()) throw InvalidInput("to_grey_image: the surface is empty");
  if (bits != 8 && bits != 16 && bits != 32)
    throw InvalidInput("to_grey_image: bits " + std::to_string(bits) + " is not 8, 16 or 32");
  GreyImage image{surface.size, surface.size, std::vector<float>(surface.heights.size()), 0, bits};
  const auto [low, high] = std::minmax_element(surface.heights.begin(), surface.heights.end());
  const double offset = *low, range = *high - *low, steps = bits == 8 ? 255 : 65535;
  std::transform(surface.heights.begin(), surface.heights.end(), image.pixels.begin(), [&](double height) {
    const double grey = range > 0 ? (height - offset) / range : 0;
    return static_cast<float>(bits == 32 ? grey : std::round(steps * grey) / steps);
  });
  return image;
}

}  // namespace papilla
