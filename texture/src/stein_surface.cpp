// SPDX-License-Identifier: GPL-3.0-or-later
#include "papilla/texture/stein_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>

#include "checks.hpp"
#include "fft.hpp"
#include "papilla/core/error.hpp"
#include "random.hpp"

namespace papilla {
namespace {

using texture_detail::RealFft2d;

/// Stein's covariance: c0 − r^α + c2 r² for r ≤ 1, β (R−r)³/r for 1 < r ≤ R, 0 beyond (his equations 3 and 4).
struct SteinCovariance {
  explicit SteinCovariance(double hurst) : alpha(2 * hurst) {
    if (alpha <= 1.5) {
      c2 = alpha / 2;
      c0 = 1 - alpha / 2;
      return;
    }
    reach = 2;
    beta = alpha * (2 - alpha) / (3 * reach * (reach * reach - 1));
    c2 = (alpha - beta * (reach - 1) * (reach - 1) * (reach + 2)) / 2;
    c0 = beta * std::pow(reach - 1, 3) + 1 - c2;
  }
  double operator()(double r) const {
    if (r <= 1) return c0 - std::pow(r, alpha) + c2 * r * r;
    return r <= reach ? beta * std::pow(reach - r, 3) / r : 0;
  }
  double alpha, reach = 1, beta = 0, c0 = 0, c2 = 0;
};

void require_options(const BrownianSurfaceOptions& options) {
  if (options.size < 2 || options.size > 2049)
    throw InvalidInput("brownian_surface_exact: size " + std::to_string(options.size) + " is not within 2 to 2049");
  if (!(options.hurst > 0 && options.hurst < 1))
    throw InvalidInput("brownian_surface_exact: hurst " + std::to_string(options.hurst) + " is not within (0, 1)");
}

/// Multiplies the spectrum in `field` by the square roots of the eigenvalues of the circulant covariance.
void colour_spectrum(RealFft2d& field, RealFft2d& covariance, int period) {
  const std::size_t count = field.spectrum_width() * static_cast<std::size_t>(period);
  double largest = 0, smallest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    largest = std::max(largest, covariance.spectrum()[i].real());
    smallest = std::min(smallest, covariance.spectrum()[i].real());
  }
  // The eigenvalues are positive in theory; rounding in the FFT costs a few units of 1e-16.
  if (smallest < -1e-9 * largest)
    throw SolverFailure("brownian_surface_exact: the circulant embedding has the negative eigenvalue " +
                        std::to_string(smallest));
  for (std::size_t i = 0; i < count; ++i)
    field.spectrum()[i] *= std::sqrt(std::max(0.0, covariance.spectrum()[i].real()));
}

}  // namespace

HeightGrid brownian_surface_exact(const BrownianSurfaceOptions& options) {
  require_options(options);
  const SteinCovariance covariance(options.hurst);
  const int n = options.size;
  const double pitch = 1 / (std::numbers::sqrt2 * (n - 1));  // The diagonal has length 1.
  const int period = texture_detail::good_fft_size(static_cast<int>(std::ceil(2 * covariance.reach / pitch)) + 1);

  constexpr std::string_view k_stage = "synthesis";
  const auto report = [&](double fraction) { report_progress(options.progress, k_stage, fraction); };
  report(0);
  RealFft2d field(period, period);
  texture_detail::Random random(options.seed);
  for (int y = 0; y < period; ++y)
    for (int x = 0; x < period; ++x) field.real(x, y) = random.normal();
  report(0.3);
  field.forward();
  report(0.45);
  {
    RealFft2d circulant(period, period);
    // All four quadrants are equal: the covariance is computed for one in four samples.
    const auto row = static_cast<std::size_t>(period);
    for (int y = 0; y <= period / 2; ++y) {
      for (int x = 0; x <= period / 2; ++x)
        circulant.real(x, y) = circulant.real((period - x) % period, y) = covariance(pitch * std::hypot(x, y));
      if (y > 0) std::copy_n(&circulant.real(0, y), row, &circulant.real(0, period - y));
    }
    report(0.65);
    circulant.forward();
    colour_spectrum(field, circulant, period);
  }
  report(0.85);
  field.backward();

  // The field has the variogram 2 r^α − 2 c2 r² with r in units of the diagonal; the plane adds the missing term.
  const double tilt = std::sqrt(2 * covariance.c2);
  const double slope_x = tilt * random.normal(), slope_y = tilt * random.normal();
  const double unfft = 1 / (static_cast<double>(period) * period);
  const double scale = std::pow(pitch, -options.hurst) / std::numbers::sqrt2;
  HeightGrid surface{n, Values<double>(static_cast<std::size_t>(n) * static_cast<std::size_t>(n)), false};
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x)
      surface.heights[texture_detail::pixel_index(x, y, n)] =
          scale * (unfft * field.real(x, y) + pitch * (slope_x * x + slope_y * y));
  report(1);
  return surface;
}

}  // namespace papilla
