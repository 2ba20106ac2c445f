// SPDX-License-Identifier: MIT
#include "papilla/haptic/roughness_field.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

constexpr int k_size = 256, k_largest_size = 2048;
constexpr int k_waves = 96;
constexpr double k_samples_per_wave = 4;
constexpr double k_assumed_hurst = 0.5;

/// A wave that repeats with a tile: kx times across it and ky times down.
struct Wave {
  int kx = 0, ky = 0;
  double amplitude = 0, phase = 0;
};

void require_numbers(const RoughnessTag& roughness, Vec2 metres_per_uv) {
  const auto is_length = [](double value) { return std::isfinite(value) && value > 0; };
  if (!is_length(roughness.wavelength_range_m.x) || !is_length(roughness.wavelength_range_m.y) ||
      !(metres_per_uv.x > 0) || !(metres_per_uv.y > 0) || !(roughness.anisotropy >= 1) ||
      !std::isfinite(roughness.anisotropy) || !std::isfinite(roughness.direction) ||
      !std::isfinite(roughness.rms_height_m) || !std::isfinite(roughness.fractal_dimension.value_or(2.5)))
    throw InvalidInput("roughness_field: lengths must be finite and > 0");
}

/// Uniform in [0, 1), the same with every standard library.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

/// @param tile_m sides of the tile. @param longest_m, shortest_m of the waves.
std::vector<Wave> draw_waves(const RoughnessTag& roughness, Vec2 tile_m, double longest_m, double shortest_m,
                             std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const double hurst = roughness.fractal_dimension ? 3 - *roughness.fractal_dimension : k_assumed_hurst;
  const double ratio = std::max(1.0, longest_m / shortest_m), stretch = std::sqrt(roughness.anisotropy);
  const Vec2 along{std::cos(roughness.direction), std::sin(roughness.direction)}, across{-along.y, along.x};
  std::vector<Wave> waves;
  for (int i = 0; i < k_waves; ++i) {
    const double octave = std::pow(ratio, (i + uniform(random)) / k_waves);  // Of the longest wave's number.
    const double direction = 2 * std::numbers::pi * uniform(random);
    const Vec2 number =
        octave / longest_m * (std::cos(direction) / stretch * along + std::sin(direction) * stretch * across);
    Wave wave{static_cast<int>(std::lround(number.x * tile_m.x)), static_cast<int>(std::lround(number.y * tile_m.y)),
              std::pow(octave, -hurst), 2 * std::numbers::pi * uniform(random)};
    if (wave.kx == 0 && wave.ky == 0) wave.kx = 1;
    waves.push_back(wave);
  }
  return waves;
}

/// Heights of the waves on a grid of columns × rows over the tile, of that root mean square.
std::vector<double> sum_of_waves(const std::vector<Wave>& waves, int columns, int rows, double rms_m) {
  std::vector<double> height(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0.0);
  // cos(2π(kx·x + ky·y) + φ) from the turns along a row, which all rows share.
  std::vector<double> cosine(static_cast<std::size_t>(columns)), sine(cosine.size());
  for (const Wave& wave : waves) {
    for (std::size_t x = 0; x < cosine.size(); ++x) {
      const double turn = 2 * std::numbers::pi * wave.kx * (static_cast<double>(x) / columns);
      cosine[x] = std::cos(turn), sine[x] = std::sin(turn);
    }
    for (int y = 0; y < rows; ++y) {
      const double turn = 2 * std::numbers::pi * wave.ky * (static_cast<double>(y) / rows) + wave.phase;
      const double c = wave.amplitude * std::cos(turn), s = wave.amplitude * std::sin(turn);
      double* const row = &height[static_cast<std::size_t>(y) * cosine.size()];
      for (std::size_t x = 0; x < cosine.size(); ++x) row[x] += c * cosine[x] - s * sine[x];
    }
  }
  double squares = 0;
  for (const double h : height) squares += h * h;
  const double rms = std::sqrt(squares / static_cast<double>(height.size()));
  const double factor = rms > 0 ? rms_m / rms : 0;
  for (double& h : height) h *= factor;
  return height;
}

/// By how many samples one of either direction has to be replaced, so that `shortest_m` has k_samples_per_wave.
int refinement(const HeightField& relief, Vec2 pitch_m, double shortest_m) {
  const double wanted = k_samples_per_wave * std::max(pitch_m.x, pitch_m.y) / shortest_m;
  const int most = std::max(1, k_largest_size / std::max(relief.width(), relief.height()));
  return static_cast<int>(std::clamp(std::ceil(wanted), 1.0, static_cast<double>(most)));
}

}  // namespace

HeightField roughness_field(const RoughnessTag& roughness, Vec2 metres_per_uv, std::uint64_t seed) {
  require_numbers(roughness, metres_per_uv);
  const double longest = roughness.wavelength_range_m.y;
  HeightFieldOptions options;
  options.uv_transform.scale = {metres_per_uv.x / longest, metres_per_uv.y / longest};
  const double shortest = std::max(roughness.wavelength_range_m.x, k_samples_per_wave * longest / k_size);
  const std::vector<Wave> waves = draw_waves(roughness, {longest, longest}, longest, shortest, seed);
  const HeightField flat(k_size, k_size, std::vector<std::uint16_t>(std::size_t{k_size} * k_size, 0), options);
  return flat.overlaid(1, sum_of_waves(waves, k_size, k_size, roughness.rms_height_m));
}

HeightField with_roughness(const HeightField& relief, const RoughnessTag& roughness, Vec2 metres_per_uv,
                           std::uint64_t seed) {
  require_numbers(roughness, metres_per_uv);
  const std::optional<Vec2> pitch = relief.pitch_m(metres_per_uv);
  if (!pitch) return relief;
  const Vec2 tile{relief.width() * pitch->x, relief.height() * pitch->y};
  const int factor = refinement(relief, *pitch, roughness.wavelength_range_m.x);
  const double longest = std::min({roughness.wavelength_range_m.y, tile.x, tile.y});
  const double shortest =
      std::max(roughness.wavelength_range_m.x, k_samples_per_wave / factor * std::max(pitch->x, pitch->y));
  const std::vector<Wave> waves = draw_waves(roughness, tile, longest, shortest, seed);
  return relief.overlaid(
      factor, sum_of_waves(waves, factor * relief.width(), factor * relief.height(), roughness.rms_height_m));
}

}  // namespace papilla
