// SPDX-License-Identifier: MIT
#include "outstanding_wave.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "checks.hpp"
#include "shading_spectrum.hpp"

namespace papilla::texture_detail {
namespace {

struct Wave {
  double log_frequency = 0, power = 0;
};

/// The waves of half the plane by rising frequency, to that of two pixels; without the longest, which the window makes.
std::vector<Wave> waves_of(const GreyImage& image) {
  constexpr double k_longest = 1.5, k_shortest_px = 2;
  const PowerSpectrum spectrum = power_spectrum(image);
  const double least = k_longest / std::min(image.width, image.height);
  std::vector<Wave> waves;
  for (int v = 0; v < spectrum.height; ++v)
    for (int u = 0; u <= spectrum.width / 2; ++u) {
      const double y = static_cast<double>(2 * v <= spectrum.height ? v : v - spectrum.height) / spectrum.height;
      const double frequency = std::hypot(static_cast<double>(u) / spectrum.width, y);
      const double power = spectrum.power[pixel_index(u, v, spectrum.width)];
      if (frequency > least && frequency < 1 / k_shortest_px && power > 0)
        waves.push_back({std::log(frequency), power});
    }
  std::sort(waves.begin(), waves.end(), [](const Wave& a, const Wave& b) { return a.log_frequency < b.log_frequency; });
  return waves;
}

/// The logarithm of the mean power over that of the frequency: straight between rings and beyond the outermost.
class MeanPower {
 public:
  explicit MeanPower(const std::vector<Wave>& waves) {
    constexpr std::size_t k_least_waves = 48;
    constexpr double k_least_width = 0.12;  // Of the logarithm of the frequency.
    std::vector<double> powers;
    double sum = 0, begin = 0;
    for (const Wave& wave : waves) {
      if (powers.empty()) begin = wave.log_frequency;
      powers.push_back(wave.power);
      sum += wave.log_frequency;
      if (powers.size() < k_least_waves || wave.log_frequency - begin < k_least_width) continue;
      const auto middle = powers.begin() + static_cast<std::ptrdiff_t>(powers.size() / 2);
      std::nth_element(powers.begin(), middle, powers.end());
      places_.push_back(sum / static_cast<double>(powers.size()));
      values_.push_back(std::log(*middle / std::numbers::ln2));  // The median of an exponential variable.
      powers.clear();
      sum = 0;
    }
  }
  bool is_known() const { return places_.size() >= 2; }
  /// @pre is_known().
  double at(double place) const {
    const auto above =
        static_cast<std::size_t>(std::upper_bound(places_.begin(), places_.end(), place) - places_.begin());
    const std::size_t k = std::clamp<std::size_t>(above, 1, places_.size() - 1);
    const double t = (place - places_[k - 1]) / (places_[k] - places_[k - 1]);
    return (1 - t) * values_[k - 1] + t * values_[k];
  }

 private:
  std::vector<double> places_, values_;
};

}  // namespace

double chance_of_highest_wave(const GreyImage& image) {
  const std::vector<Wave> waves = waves_of(image);
  const MeanPower mean(waves);
  if (!mean.is_known()) return 1;
  double highest = 0;
  for (const Wave& wave : waves) highest = std::max(highest, wave.power / std::exp(mean.at(wave.log_frequency)));
  return -std::expm1(-static_cast<double>(waves.size()) * std::exp(-highest));
}

}  // namespace papilla::texture_detail
