// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <complex>
#include <numbers>
#include <numeric>

#include "checks.hpp"
#include "fft.hpp"
#include "papilla/texture/shape_from_shading.hpp"
#include "reflectance.hpp"
#include "slopes.hpp"

namespace papilla {
namespace {

using Field = std::vector<double>;

/// Angular frequency of row or column k of a transform of n; 0 for the highest one, whose derivative is not real.
double frequency(int k, int n) {
  if (2 * k == n) return 0;
  return 2 * std::numbers::pi * (2 * k < n ? k : k - n) / n;
}

/// Turns the spectrum of the brightness into that of the heights.
void integrate(texture_detail::RealFft2d& fft, int width, int height, Vec3 light) {
  constexpr double k_damping = 0.1;
  const double oblique = light.x * light.x + light.y * light.y;
  const double norm = 1 / (static_cast<double>(width) * height);
  std::complex<double>* value = fft.spectrum();
  for (int v = 0; v < height; ++v)
    for (int u = 0; u <= width / 2; ++u, ++value) {
      const double wx = frequency(u, width), wy = frequency(v, height);
      const double along = light.x * wx + light.y * wy;
      const double power = along * along + k_damping * k_damping * oblique * (wx * wx + wy * wy);
      *value *= power > 0 ? std::complex(0.0, norm * along / power) : std::complex<double>();
    }
}

/// Root mean square of brightness − R over the slopes of the heights.
double residual(const Field& height, const Field& brightness, int width, int rows, Vec3 light, bool periodic) {
  double squares = 0;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < width; ++x) {
      const texture_detail::Stencil across = texture_detail::stencil(x, width, periodic);
      const texture_detail::Stencil down = texture_detail::stencil(y, rows, periodic);
      const auto at = [&](int column, int row) { return height[texture_detail::pixel_index(column, row, width)]; };
      const double p = (at(across.after, y) - at(across.before, y)) / across.span;
      const double q = (at(x, down.after) - at(x, down.before)) / down.span;
      const double error =
          brightness[texture_detail::pixel_index(x, y, width)] - texture_detail::reflectance(light, p, q).value;
      squares += error * error;
    }
  return std::sqrt(squares / static_cast<double>(height.size()));
}

}  // namespace

ShadingResult shape_from_shading_pentland(const GreyImage& image, const ShadingOptions& options) {
  texture_detail::require_shading(image, options, "shape_from_shading_pentland");
  const Vec3 light =
      texture_detail::oblique(texture_detail::require_light(options.light, "shape_from_shading_pentland"));
  const Stopwatch clock;
  const Field brightness = texture_detail::brightness(image, options.albedo);
  const double mean =
      std::accumulate(brightness.begin(), brightness.end(), 0.0) / static_cast<double>(brightness.size());
  const auto padded = [&](int side) {
    return options.periodic ? side : texture_detail::good_fft_size(side + side / 4);
  };
  const int width = padded(image.width), height = padded(image.height);
  texture_detail::RealFft2d fft(width, height);
  std::fill_n(fft.real(), fft.stride() * static_cast<std::size_t>(height), 0.0);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      fft.real(x, y) = brightness[texture_detail::pixel_index(x, y, image.width)] - mean;
  fft.forward();
  integrate(fft, width, height, light);
  fft.backward();
  ShadingResult result;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) result.height_px.push_back(fft.real(x, y));
  texture_detail::remove_mean(result.height_px);
  result.stop = StopReason::direct;
  result.trace.push_back(
      {clock.seconds(), residual(result.height_px, brightness, image.width, image.height, light, options.periodic)});
  return result;
}

}  // namespace papilla
