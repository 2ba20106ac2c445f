// SPDX-License-Identifier: MIT
#include "papilla/texture/light_direction.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "checks.hpp"
#include "papilla/core/units.hpp"
#include "papilla/texture/resample.hpp"
#include "papilla/texture/stored_samples.hpp"
#include "shading_spectrum.hpp"

namespace papilla {
namespace {

using namespace texture_detail;

constexpr double k_pi = std::numbers::pi;

/// g_2 / g_0 and g_4 / g_0 of LightEstimate; 0 for a flat picture.
struct Harmonics {
  std::complex<double> second, fourth;
};

double signed_frequency(int k, int n) { return 2 * k_pi * (2 * k <= n ? k : k - n) / n; }

Harmonics harmonics_of(const GreyImage& image) {
  const PowerSpectrum spectrum = power_spectrum(image);
  const double longest = 4 * k_pi / std::max(image.width, image.height);
  constexpr double k_highest = 1.6, k_noise_from = 2.2, k_noise_to = 3;
  std::vector<double> noises;
  const auto each_wave = [&](const auto& visit) {
    for (int v = 0; v < image.height; ++v)
      for (int u = 0; u < image.width; ++u) {
        const double wx = signed_frequency(u, image.width), wy = signed_frequency(v, image.height);
        visit(std::complex<double>(wx, wy), spectrum.power[pixel_index(u, v, image.width)]);
      }
  };
  each_wave([&](std::complex<double> wave, double power) {
    const double frequency = std::abs(wave);
    if (frequency > k_noise_from && frequency < k_noise_to) noises.push_back(power);
  });
  double noise = 0;
  if (!noises.empty()) {
    const auto middle = noises.begin() + static_cast<std::ptrdiff_t>(noises.size() / 2);
    std::nth_element(noises.begin(), middle, noises.end());
    noise = *middle / std::numbers::ln2;
  }
  double total = 0;
  Harmonics harmonics;
  each_wave([&](std::complex<double> wave, double power) {
    const double frequency = std::abs(wave);
    if (!(frequency > longest && frequency < k_highest)) return;
    const double weight = (power - noise) * frequency * frequency;
    const std::complex<double> turn = std::conj(wave / frequency), twice = turn * turn;
    total += weight;
    harmonics.second += weight * twice;
    harmonics.fourth += weight * twice * twice;
  });
  if (!(total > 0)) return {};
  return {harmonics.second / total, harmonics.fourth / total};
}

struct Axis {
  double angle = 0, coherence = 0;
};

Axis axis_of(const Harmonics& g) {
  constexpr int k_steps = 720;
  constexpr double k_nearer = 0.3;  // Weight of the strongest gradient, which decides between two angles.
  const double strongest = std::arg(std::conj(g.second)) / 2;
  double least = 1e300;
  Axis axis;
  for (int step = 0; step < k_steps; ++step) {
    const double angle = k_pi * step / k_steps;
    const std::complex<double> turn = std::polar(1.0, 2 * angle);
    const double off = std::sin(angle - strongest);
    const double cost =
        std::norm(g.second - 0.5 * (std::conj(turn) + g.fourth * turn)) + k_nearer * std::norm(g.second) * off * off;
    if (cost < least) least = cost, axis.angle = angle;
  }
  const std::complex<double> turn = std::polar(1.0, 2 * axis.angle);
  const std::complex<double> lit = 0.5 * (std::conj(turn) + g.fourth * turn);
  const double square = std::norm(lit);
  if (square > 0) axis.coherence = std::clamp(0.5 * std::real(std::conj(lit) * g.second) / square, 0.0, 1.0);
  return axis;
}

/// Standard deviation of the axis by leaving out one of nine parts at a time, radians.
double jackknife(const GreyImage& image, double angle) {
  constexpr int k_parts = 3, k_least_px = 16;
  const int width = image.width / k_parts, height = image.height / k_parts;
  if (std::min(width, height) < k_least_px) return k_pi;
  std::vector<Harmonics> parts;
  for (int j = 0; j < k_parts; ++j)
    for (int i = 0; i < k_parts; ++i) parts.push_back(harmonics_of(crop(image, i * width, j * height, width, height)));
  const auto count = static_cast<double>(parts.size());
  Harmonics sum;
  for (const Harmonics& part : parts) sum.second += part.second, sum.fourth += part.fourth;
  double squares = 0;
  for (const Harmonics& part : parts) {
    const Axis without = axis_of({(sum.second - part.second) / (count - 1), (sum.fourth - part.fourth) / (count - 1)});
    const double off = std::remainder(without.angle - angle, k_pi);
    squares += off * off;
  }
  return std::sqrt((count - 1) / count * squares);
}

LightEstimate estimate(const GreyImage& image) {
  LightEstimate result;
  constexpr int k_least_px = 8;
  if (std::min(image.width, image.height) < k_least_px) return result;
  const Harmonics harmonics = harmonics_of(image);
  const Axis axis = axis_of(harmonics);
  result.coherence = axis.coherence;
  if (!(result.coherence > 0)) return result;
  // What the relief's own directions add: four of them leave two angles, other ones are taken for the light's.
  constexpr double k_isotropic_deg = 3, k_directed_deg = 30, k_least_deg = 1, k_unknown_deg = 52;
  const double own = k_isotropic_deg + k_directed_deg * std::norm(harmonics.fourth);
  const double spread = jackknife(image, axis.angle) * k_degrees_per_radian;
  result.uncertainty_deg = std::clamp(std::hypot(spread, own), k_least_deg, k_unknown_deg);
  Vec2 azimuth{std::cos(axis.angle), std::sin(axis.angle)};
  constexpr double k_horizontal = 1e-6;
  if (azimuth.y > k_horizontal || (std::abs(azimuth.y) <= k_horizontal && azimuth.x > 0)) azimuth = -1.0 * azimuth;
  const double elevation = result.elevation_deg * k_radians_per_degree;
  result.direction = {std::cos(elevation) * azimuth.x, std::cos(elevation) * azimuth.y, std::sin(elevation)};
  return result;
}

}  // namespace

LightEstimate estimate_light(const GreyImage& image) {
  require_image(image, "estimate_light");
  return estimate_light(SamplesInMemory(image.pixels, image.width, image.height));
}

LightEstimate estimate_light(const SampleRows& picture) { return estimate(middle_of(picture)); }

}  // namespace papilla
