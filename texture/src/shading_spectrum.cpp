// SPDX-License-Identifier: GPL-3.0-or-later
#include "shading_spectrum.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>

#include "checks.hpp"
#include "fft.hpp"

namespace papilla::texture_detail {
namespace {

constexpr double k_pi = std::numbers::pi;
constexpr double k_least_ratio = 0.01;  ///< Damping of waves along which the light does not shade, as Pentland's.

double signed_frequency(int k, int n) { return 2 * k_pi * (2 * k <= n ? k : k - n) / n; }

/// cos² of the angle between a wave and the light.
double along_light(Vec2 azimuth, double wx, double wy) {
  const double square = wx * wx + wy * wy;
  const double along = azimuth.x * wx + azimuth.y * wy;
  return square > 0 ? along * along / square : 0;
}

/// Gaussian of one step, around the borders.
PowerSpectrum smoothed(const PowerSpectrum& spectrum) {
  constexpr int k_reach = 3;
  std::array<double, 2 * k_reach + 1> weights{};
  double sum = 0;
  for (int i = -k_reach; i <= k_reach; ++i)
    sum += weights[static_cast<std::size_t>(i + k_reach)] = std::exp(-0.5 * i * i);
  for (double& weight : weights) weight /= sum;
  const int width = spectrum.width, height = spectrum.height;
  PowerSpectrum across = spectrum, result = spectrum;
  const auto smooth = [&](const PowerSpectrum& from, PowerSpectrum& to, int dx, int dy) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        double value = 0;
        for (int i = -k_reach; i <= k_reach; ++i)
          value += weights[static_cast<std::size_t>(i + k_reach)] *
                   from.power[pixel_index(wrapped(x + i * dx, width), wrapped(y + i * dy, height), width)];
        to.power[pixel_index(x, y, width)] = value;
      }
  };
  smooth(spectrum, across, 1, 0);
  smooth(across, result, 0, 1);
  return result;
}

/// Power over angles of one ring.
struct Ring {
  std::vector<double> along, power, weight;
};

constexpr int k_angles = 8;

Ring ring_of(const PowerSpectrum& spectrum, Vec2 azimuth, double log_frequency) {
  constexpr double k_half_width = 0.25;
  constexpr std::size_t k_least_waves = 24;
  std::array<std::vector<double>, k_angles> powers;
  std::array<double, k_angles> along{};
  std::size_t waves = 0;
  const double least = std::exp(log_frequency - k_half_width), most = std::exp(log_frequency + k_half_width);
  for (int v = 0; v < spectrum.height; ++v) {
    const double wy = signed_frequency(v, spectrum.height);
    if (std::abs(wy) > most) continue;
    for (int u = 0; u < spectrum.width; ++u) {
      const double wx = signed_frequency(u, spectrum.width), frequency = std::hypot(wx, wy);
      if (!(frequency > least && frequency < most)) continue;
      const double c2 = along_light(azimuth, wx, wy);
      const double angle = std::acos(std::sqrt(std::min(1.0, c2)));
      const auto bin = static_cast<std::size_t>(std::min(k_angles - 1.0, angle / (k_pi / 2) * k_angles));
      powers[bin].push_back(spectrum.power[pixel_index(u, v, spectrum.width)]);
      along[bin] += c2;
      ++waves;
    }
  }
  Ring ring;
  if (waves < k_least_waves) return ring;
  for (std::size_t bin = 0; bin < k_angles; ++bin) {
    std::vector<double>& values = powers[bin];
    if (values.empty()) continue;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    ring.along.push_back(along[bin] / static_cast<double>(values.size()));
    ring.power.push_back(*middle /
                         std::numbers::ln2);  // The median of an exponential distribution is ln 2 of its mean.
    ring.weight.push_back(static_cast<double>(values.size()));
  }
  return ring;
}

/// S and N of a ring, both positive, that make the powers most likely (multiplicative steps of Itakura and Saito's
/// divergence).
std::array<double, 2> signal_and_noise(const Ring& ring) {
  double signal = 0;
  for (const double power : ring.power) signal += power / static_cast<double>(ring.power.size());
  double noise = 0.1 * signal;
  constexpr int k_steps = 20;
  for (int step = 0; step < k_steps && signal + noise > 0; ++step) {
    double signal_up = 0, signal_down = 0, noise_up = 0, noise_down = 0;
    for (std::size_t i = 0; i < ring.power.size(); ++i) {
      const double model = signal * ring.along[i] + noise;
      if (!(model > 0)) continue;
      const double pull = ring.weight[i] * ring.power[i] / (model * model), push = ring.weight[i] / model;
      signal_up += ring.along[i] * pull;
      signal_down += ring.along[i] * push;
      noise_up += pull;
      noise_down += push;
    }
    if (!(signal_down > 0 && noise_down > 0)) break;
    signal *= std::sqrt(signal_up / signal_down);
    noise *= std::sqrt(noise_up / noise_down);
  }
  return {signal, noise};
}

/// Values over sorted places, constant beyond the ends.
double interpolated(const std::vector<double>& places, const std::vector<double>& values, double place) {
  const auto after = std::upper_bound(places.begin(), places.end(), place);
  if (after == places.begin()) return values.front();
  if (after == places.end()) return values.back();
  const auto i = static_cast<std::size_t>(after - places.begin());
  const double share = (place - places[i - 1]) / (places[i] - places[i - 1]);
  return (1 - share) * values[i - 1] + share * values[i];
}

}  // namespace

GreyImage middle_of(const SampleRows& samples) {
  const int width = std::min(samples.width(), k_spectrum_px), height = std::min(samples.height(), k_spectrum_px);
  GreyImage middle{width, height, {}, 0, 32};
  middle.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y)
    samples.read((samples.width() - width) / 2, (samples.height() - height) / 2 + y, width, &middle.at(0, y));
  return middle;
}

PowerSpectrum power_spectrum(const GreyImage& image) {
  const int width = image.width, height = image.height;
  const auto window = [](int i, int count) { return 0.5 - 0.5 * std::cos(2 * k_pi * (i + 0.5) / count); };
  const double mean =
      std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0) / static_cast<double>(image.pixels.size());
  RealFft2d fft(width, height);
  double squares = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double weight = window(x, width) * window(y, height);
      fft.real(x, y) = weight * (static_cast<double>(image.at(x, y)) - mean);
      squares += weight * weight;
    }
  fft.forward();
  PowerSpectrum result{width, height, std::vector<double>(image.pixels.size())};
  for (int v = 0; v < height; ++v)
    for (int u = 0; u <= width / 2; ++u) {
      const double power =
          std::norm(fft.spectrum()[static_cast<std::size_t>(v) * fft.spectrum_width() + static_cast<std::size_t>(u)]) /
          squares;
      result.power[pixel_index(u, v, width)] = power;
      result.power[pixel_index(wrapped(-u, width), wrapped(-v, height), width)] = power;
    }
  return result;
}

ShadingSpectrum::ShadingSpectrum(const GreyImage& brightness, Vec3 light) {
  const double length = std::hypot(light.x, light.y);
  azimuth_ = length > 0 ? Vec2{light.x / length, light.y / length} : Vec2{1, 0};
  const PowerSpectrum spectrum = power_spectrum(brightness);
  smooth_ = smoothed(spectrum);
  constexpr double k_step = 0.2, k_highest = 1.2 * k_pi;
  const double lowest = 2 * k_pi / std::max(brightness.width, brightness.height);
  for (double place = std::log(lowest); place < std::log(k_highest); place += k_step) {
    const Ring ring = ring_of(spectrum, azimuth_, place);
    if (ring.power.empty()) continue;
    const auto [signal, noise] = signal_and_noise(ring);
    log_frequency_.push_back(place);
    signal_.push_back(signal);
    noise_.push_back(noise);
  }
  if (signal_.empty()) log_frequency_ = {0}, signal_ = {1}, noise_ = {0};
  const double most = *std::max_element(signal_.begin(), signal_.end());
  constexpr double k_least_share = 1e-9;
  for (std::vector<double>* values : {&signal_, &noise_})
    for (double& value : *values) value = std::log(value + k_least_share * most + 1e-300);
}

ShadingSpectrum::Ratio ShadingSpectrum::at(double wx, double wy) const {
  const double place = std::log(std::max(1e-9, std::hypot(wx, wy)));
  const double ring = std::exp(interpolated(log_frequency_, signal_, place));
  const double noise = std::exp(interpolated(log_frequency_, noise_, place));
  const double x = wx / (2 * k_pi) * smooth_.width, y = wy / (2 * k_pi) * smooth_.height;
  const double left = std::floor(x), above = std::floor(y), fx = x - left, fy = y - above;
  const auto power = [&](double column, double row) {
    return smooth_.power[pixel_index(wrapped(static_cast<int>(column), smooth_.width),
                                     wrapped(static_cast<int>(row), smooth_.height), smooth_.width)];
  };
  const double here = (1 - fy) * ((1 - fx) * power(left, above) + fx * power(left + 1, above)) +
                      fy * ((1 - fx) * power(left, above + 1) + fx * power(left + 1, above + 1));
  constexpr double k_across = 0.15;  // Waves across the light are no evidence of slopes beyond the ring's.
  return {std::max(ring, std::max(0.0, here - noise) / (along_light(azimuth_, wx, wy) + k_across)), noise};
}

double ShadingSpectrum::noise_ratio(double wx, double wy) const {
  const Ratio ratio = at(wx, wy);
  return k_least_ratio + (ratio.noise > 0 ? ratio.noise / std::max(ratio.signal, 1e-12 * ratio.noise) : 0);
}

double ShadingSpectrum::expected_correlation() const {
  constexpr double k_longest_waves = 1.5;  // Waves per side; longer ones are the flattening's.
  constexpr double k_measured = 0.93;      // Mean of the true correlation over the expected one; see wiener.md.
  const double least = 2 * k_pi * k_longest_waves / std::max(smooth_.width, smooth_.height);
  double kept = 0, all = 0;
  for (int v = 0; v < smooth_.height; ++v)
    for (int u = 0; u <= smooth_.width / 2; ++u) {
      const double wx = signed_frequency(u, smooth_.width), wy = signed_frequency(v, smooth_.height);
      const double square = wx * wx + wy * wy;
      if (!(square > least * least)) continue;
      const Ratio ratio = at(wx, wy);
      const double height = ratio.signal / square, along = along_light(azimuth_, wx, wy);
      kept += height * along / (along + noise_ratio(wx, wy));
      all += height;
    }
  return all > 0 ? k_measured * std::sqrt(kept / all) : 0;
}

}  // namespace papilla::texture_detail
