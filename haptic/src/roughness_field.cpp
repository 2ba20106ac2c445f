// SPDX-License-Identifier: MIT
#include "papilla/haptic/roughness_field.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

constexpr int k_size = 256;
constexpr int k_waves = 96;
constexpr double k_middle_dimension = 2.5;  // For a relief whose roughness follows no power law.
constexpr double k_samples_per_wave = 4;

struct Wave {
  int kx = 0, ky = 0;
  double amplitude = 0, phase = 0;
};

/// Uniform in [0, 1), the same with every standard library.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

std::vector<Wave> draw_waves(const RoughnessTag& roughness, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const double longest = roughness.wavelength_range_m.y;
  const double most = std::clamp(longest / roughness.wavelength_range_m.x, 1.0, k_size / k_samples_per_wave);
  const double hurst = 3 - roughness.fractal_dimension.value_or(k_middle_dimension);
  std::vector<Wave> waves;
  for (int i = 0; i < k_waves; ++i) {
    const double wave_number = std::pow(most, (i + uniform(random)) / k_waves);
    const double direction = 2 * std::numbers::pi * uniform(random);
    Wave wave{static_cast<int>(std::lround(wave_number * std::cos(direction))),
              static_cast<int>(std::lround(wave_number * std::sin(direction))), 0,
              2 * std::numbers::pi * uniform(random)};
    if (wave.kx == 0 && wave.ky == 0) wave.kx = 1;
    wave.amplitude = std::pow(std::hypot(wave.kx, wave.ky), -hurst - 0.5);
    waves.push_back(wave);
  }
  return waves;
}

}  // namespace

HeightField roughness_field(const RoughnessTag& roughness, Vec2 metres_per_uv, std::uint64_t seed) {
  const double longest = roughness.wavelength_range_m.y;
  if (!(roughness.wavelength_range_m.x > 0) || !(longest > 0) || !std::isfinite(longest) || !(metres_per_uv.x > 0) ||
      !(metres_per_uv.y > 0) || !std::isfinite(roughness.rms_height_m) ||
      !std::isfinite(roughness.fractal_dimension.value_or(k_middle_dimension)))
    throw InvalidInput("roughness_field: lengths must be finite and > 0");

  std::vector<double> height(static_cast<std::size_t>(k_size) * k_size, 0.0);
  std::array<double, k_size> cosine{};
  for (int i = 0; i < k_size; ++i) cosine[static_cast<std::size_t>(i)] = std::cos(2 * std::numbers::pi * i / k_size);
  for (const Wave& wave : draw_waves(roughness, seed)) {
    const double c = wave.amplitude * std::cos(wave.phase), s = wave.amplitude * std::sin(wave.phase);
    std::size_t at = 0;
    for (int y = 0; y < k_size; ++y)
      for (int x = 0; x < k_size; ++x, ++at) {
        const int turn = wave.kx * x + wave.ky * y;
        height[at] += c * cosine[static_cast<std::size_t>(turn & (k_size - 1))] -
                      s * cosine[static_cast<std::size_t>((turn - k_size / 4) & (k_size - 1))];
      }
  }
  double sum2 = 0;
  for (const double h : height) sum2 += h * h;
  const double rms = std::sqrt(sum2 / static_cast<double>(height.size()));
  const double factor = rms > 0 ? roughness.rms_height_m / rms : 0;
  const auto [low, high] = std::minmax_element(height.begin(), height.end());
  const double bottom = *low, range = *high - bottom;

  HeightFieldOptions options;
  options.offset_m = factor * bottom;
  options.scale_m = factor * range;
  options.uv_transform.scale = {metres_per_uv.x / longest, metres_per_uv.y / longest};
  std::vector<std::uint16_t> samples;
  samples.reserve(height.size());
  for (const double h : height)
    samples.push_back(static_cast<std::uint16_t>(range > 0 ? std::lround(65535 * (h - bottom) / range) : 0));
  return HeightField(k_size, k_size, std::move(samples), options);
}

}  // namespace papilla
