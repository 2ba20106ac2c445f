// SPDX-License-Identifier: MIT
#include "papilla/pipeline/felt_waves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "papilla/core/units.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/part_roughness.hpp"
#include "papilla/texture/resample.hpp"

namespace papilla {
namespace {

constexpr int k_speeds = 16;
constexpr double k_samples_per_wave = 4;  // As with_roughness().
constexpr double k_last_hz = k_touch_receptors.back().high_hz;

double frequency_hz(const WaveBand& band, double speed_m_per_s) {
  return speed_m_per_s / (k_metres_per_mm * band.wave_mm());
}

/// (a/A)² of a band.
double excess(const WaveBand& band, double speed_m_per_s) {
  const double amplitude = std::numbers::sqrt2 * k_metres_per_mm * std::sqrt(band.variance_mm2);
  const double times = amplitude / vibrotactile_threshold_m(frequency_hz(band, speed_m_per_s));
  return times * times;
}

std::vector<double> speeds_of(const TouchOptions& options) {
  std::vector<double> speeds;
  for (int i = 0; i < k_speeds; ++i)
    speeds.push_back(options.speed_m_per_s * options.slow *
                     std::pow(options.fast / options.slow, static_cast<double>(i) / (k_speeds - 1)));
  return speeds;
}

std::vector<ReceptorShare> receptor_shares(std::span<const WaveBand> bands, double speed_m_per_s) {
  double variance = 0;
  for (const WaveBand& band : bands) variance += band.variance_mm2;
  std::vector<ReceptorShare> shares;
  for (const TouchReceptor& receptor : k_touch_receptors) {
    ReceptorShare share{receptor.name, 0, 0};
    for (const WaveBand& band : bands) {
      const double hz = frequency_hz(band, speed_m_per_s);
      if (hz < receptor.low_hz || hz > receptor.high_hz) continue;
      share.variance_share += variance > 0 ? band.variance_mm2 / variance : 0;
      share.times_threshold += excess(band, speed_m_per_s);
    }
    share.times_threshold = std::sqrt(share.times_threshold);
    shares.push_back(share);
  }
  return shares;
}

}  // namespace

double vibrotactile_threshold_m(double frequency_hz) {
  constexpr double k_least_m = 1e-7, k_best_hz = 250, k_flat_hz = 40;
  if (frequency_hz > k_last_hz) return std::numeric_limits<double>::infinity();
  const double hz = std::max(frequency_hz, k_flat_hz), ratio = hz < k_best_hz ? k_best_hz / hz : hz / k_best_hz;
  return k_least_m * ratio * ratio;
}

double finest_wave_mm(const TouchOptions& options) {
  return options.slow * options.speed_m_per_s / (k_metres_per_mm * k_last_hz);
}

int needed_samples(int samples, double pitch_mm, double finest_mm) {
  return std::clamp(static_cast<int>(std::ceil(samples * pitch_mm * k_samples_per_wave / finest_mm)), 1, samples);
}

FeltWaves measure_felt_waves(std::span<const WaveBand> bands, const TouchOptions& options) {
  FeltWaves felt;
  felt.receptors = receptor_shares(bands, options.speed_m_per_s);
  felt.may_be_left_out = true;
  if (bands.empty()) return felt;
  felt.slowest_hz = options.speed_m_per_s / (k_metres_per_mm * bands.back().longest_mm);
  felt.fastest_hz = options.speed_m_per_s / (k_metres_per_mm * bands.front().shortest_mm);
  double variance = 0;
  for (const WaveBand& band : bands) {
    variance += band.variance_mm2;
    if (frequency_hz(band, options.speed_m_per_s) > k_last_hz) felt.unfelt_share += band.variance_mm2;
    const double square = excess(band, options.speed_m_per_s);
    felt.times_threshold += square;
    if (band.wave_mm() <= k_longest_roughness_mm) felt.roughness += square;
  }
  if (variance > 0) felt.unfelt_share /= variance;
  felt.times_threshold = std::sqrt(felt.times_threshold);
  felt.roughness = std::sqrt(felt.roughness);
  const double most = 1 / (options.margin * options.margin);
  double finest_mm = std::numeric_limits<double>::infinity();
  for (const double speed : speeds_of(options)) {
    double sum = 0;
    for (const WaveBand& band : bands) {
      sum += excess(band, speed);
      if (sum > most) finest_mm = std::min(finest_mm, band.shortest_mm);
    }
    felt.most_times_threshold = std::max(felt.most_times_threshold, std::sqrt(sum));
  }
  felt.may_be_left_out = !std::isfinite(finest_mm);
  if (!felt.may_be_left_out && finest_mm > bands.front().shortest_mm) felt.finest_felt_mm = finest_mm;
  return felt;
}

ReliefSaving measure_relief_saving(const HeightMap& relief, const FeltWaves& felt, std::size_t bytes) {
  ReliefSaving saving{relief.width, relief.height, relief.width, relief.height, bytes, bytes};
  if (felt.may_be_left_out) {
    saving.needed_width = saving.needed_height = 0;
    saving.needed_bytes = 0;
    return saving;
  }
  if (!(felt.finest_felt_mm > 0)) return saving;
  const int width = needed_samples(relief.width, relief.pitch_mm_x, felt.finest_felt_mm);
  const int height = needed_samples(relief.height, relief.pitch_mm_y, felt.finest_felt_mm);
  if (width == relief.width && height == relief.height) return saving;
  const std::size_t needed = encode_height_png16(resample(relief, width, height)).png.size();
  if (needed >= bytes) return saving;
  saving.needed_width = width, saving.needed_height = height, saving.needed_bytes = needed;
  return saving;
}

}  // namespace papilla
