// SPDX-License-Identifier: GPL-3.0-or-later
#include "papilla/texture/wave_bands.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "checks.hpp"
#include "fft.hpp"

namespace papilla {
namespace {

constexpr double k_per_octave = 3;

/// Number of the band of a wavelength; band n reaches from 2^(n/3) mm to 2^((n+1)/3) mm.
int band_of(double wave_mm) { return static_cast<int>(std::floor(k_per_octave * std::log2(wave_mm) + 1e-9)); }
double begin_of(int band) { return std::exp2(band / k_per_octave); }

/// Loads the relief less its mean, reflected at its borders where `times` is 2.
void load(const HeightMap& relief, int times, texture_detail::RealFft2d& fft) {
  const double mean = std::accumulate(relief.mm.begin(), relief.mm.end(), 0.0) / static_cast<double>(relief.mm.size());
  const auto inside = [](int i, int side) { return i < side ? i : 2 * side - 1 - i; };
  for (int y = 0; y < times * relief.height; ++y)
    for (int x = 0; x < times * relief.width; ++x)
      fft.real(x, y) = static_cast<double>(relief.at(inside(x, relief.width), inside(y, relief.height))) - mean;
}

std::vector<WaveBand> without_gaps(const std::map<int, double>& variances) {
  std::vector<WaveBand> bands;
  if (variances.empty()) return bands;
  for (int band = variances.begin()->first; band <= variances.rbegin()->first; ++band) {
    const auto found = variances.find(band);
    bands.push_back({begin_of(band), begin_of(band + 1), found == variances.end() ? 0 : found->second});
  }
  return bands;
}

}  // namespace

double WaveBand::wave_mm() const noexcept { return std::sqrt(shortest_mm * longest_mm); }

std::vector<WaveBand> wave_bands(const HeightMap& relief, bool repeats) {
  texture_detail::require_height_map(relief, "wave_bands", true);
  const int times = repeats ? 1 : 2, width = times * relief.width, height = times * relief.height;
  texture_detail::RealFft2d fft(width, height);
  load(relief, times, fft);
  fft.forward();
  const double samples = static_cast<double>(width) * height;
  std::map<int, double> variances;
  for (int y = 0; y < height; ++y)
    for (std::size_t x = 0; x < fft.spectrum_width(); ++x) {
      const double power =
          std::norm(fft.spectrum()[static_cast<std::size_t>(y) * fft.spectrum_width() + x]) / (samples * samples);
      const double across = static_cast<double>(x) / (width * relief.pitch_mm_x);
      const double down = (2 * y <= height ? y : y - height) / (height * relief.pitch_mm_y);
      const double frequency = std::hypot(across, down);
      if (!(frequency > 0) || !(power > 0)) continue;
      const bool has_twin = x > 0 && 2 * static_cast<int>(x) != width;  // Of the half that is not stored.
      variances[band_of(1 / frequency)] += has_twin ? 2 * power : power;
    }
  return without_gaps(variances);
}

void add_roughness(std::vector<WaveBand>& bands, const RoughnessModel& roughness) {
  std::map<int, double> variances;
  for (const WaveBand& band : bands) variances[band_of(band.wave_mm())] = band.variance_mm2;
  const int first = band_of(roughness.shortest_mm), last = band_of(roughness.longest_mm);
  double sum = 0;
  const auto share = [&](int band) {
    const double low = std::max(begin_of(band), roughness.shortest_mm);
    const double high = std::min(begin_of(band + 1), roughness.longest_mm);
    return high > low ? std::pow(high, 2 * roughness.hurst) - std::pow(low, 2 * roughness.hurst) : 0;
  };
  for (int band = first; band <= last; ++band) sum += share(band);
  if (!(sum > 0)) return;
  for (int band = first; band <= last; ++band)
    variances[band] += roughness.rms_mm * roughness.rms_mm * share(band) / sum;
  bands = without_gaps(variances);
}

}  // namespace papilla
