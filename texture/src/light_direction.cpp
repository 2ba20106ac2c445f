// SPDX-License-Identifier: MIT
#include "papilla/texture/light_direction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>
#include <vector>

#include "checks.hpp"
#include "papilla/core/units.hpp"
#include "papilla/texture/resample.hpp"
#include "papilla/texture/stored_samples.hpp"
#include "shading_spectrum.hpp"
#include "shaped_noise.hpp"

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

/// Gradients of a picture by their direction, over neighbourhoods of a few pixels.
struct LocalGradients {
  static constexpr std::size_t k_directions = 36;       ///< Over half a turn.
  std::array<double, k_directions> pixels{}, energy{};  ///< Of neighbourhoods with a direction; energy: their sum.
  double common = 0;  ///< Share of one direction in [0, 1], see LightEstimate; an isotropic relief has less than ½.
};

std::vector<double> blurred(std::vector<double> field, int width, int height, double deviation_px) {
  const double rate = 2 * k_pi * k_pi * deviation_px * deviation_px;
  filter(field, width, height, false, [=](double x, double y) { return std::exp(-rate * (x * x + y * y)); });
  return field;
}

LocalGradients local_gradients(const GreyImage& image) {
  constexpr double k_picture_px = 1.5, k_tensor_px = 2.5, k_directed = 0.3;
  const int width = image.width, height = image.height;
  const std::vector<double> grey = blurred({image.pixels.begin(), image.pixels.end()}, width, height, k_picture_px);
  std::array<std::vector<double>, 3> tensor;  // xx, xy, yy
  for (std::vector<double>& part : tensor) part.assign(grey.size(), 0.0);
  for (int y = 1; y + 1 < height; ++y)
    for (int x = 1; x + 1 < width; ++x) {
      const std::size_t i = pixel_index(x, y, width);
      const double gx = grey[i + 1] - grey[i - 1];
      const double gy = grey[pixel_index(x, y + 1, width)] - grey[pixel_index(x, y - 1, width)];
      tensor[0][i] = gx * gx;
      tensor[1][i] = gx * gy;
      tensor[2][i] = gy * gy;
    }
  for (std::vector<double>& part : tensor) part = blurred(std::move(part), width, height, k_tensor_px);
  LocalGradients result;
  std::complex<double> sum;
  for (std::size_t i = 0; i < grey.size(); ++i) {
    const double trace = tensor[0][i] + tensor[2][i];
    const std::complex<double> directed(tensor[0][i] - tensor[2][i], 2 * tensor[1][i]);
    const double size = std::abs(directed);
    if (!(trace > 0)) continue;
    sum += directed / trace;
    if (size < k_directed * trace) continue;
    const double turns = std::arg(directed) / (2 * k_pi);  // Of half a turn.
    const auto direction = static_cast<std::size_t>((turns - std::floor(turns)) * LocalGradients::k_directions) %
                           LocalGradients::k_directions;
    result.pixels[direction] += 1;
    result.energy[direction] += (trace + size) / 2;
  }
  result.common = std::abs(sum) / static_cast<double>(grey.size());
  return result;
}

/// The axis at which the mean energy of a direction θ follows cos²(θ − φ) best (Itakura and Saito's divergence, over
/// the pixels that have that direction), and its standard deviation, radians.
struct LocalAxis {
  double angle = 0, deviation = 0;
};

LocalAxis local_axis(const LocalGradients& local, double strongest) {
  constexpr double k_across = 0.05;  // Second order and noise leave this much across the light.
  constexpr double k_nearer = 0.1;   // Weight of the strongest gradient, which decides where the directions are few.
  constexpr double k_evidence = 16;  // Independent values in the divergence; makes the deviation cover.
  constexpr std::size_t k_steps = 360;
  double pixels = 0;
  for (const double count : local.pixels) pixels += count;
  std::array<double, k_steps> cost{};
  for (std::size_t step = 0; step < k_steps; ++step) {
    const double angle = k_pi * static_cast<double>(step) / k_steps;
    std::array<double, LocalGradients::k_directions> ratio{};
    double mean = 0;
    for (std::size_t k = 0; k < ratio.size(); ++k) {
      if (!(local.pixels[k] > 0)) continue;
      const double along = std::cos(k_pi * (static_cast<double>(k) + 0.5) / LocalGradients::k_directions - angle);
      ratio[k] = local.energy[k] / local.pixels[k] / (along * along + k_across);
      mean += local.pixels[k] / pixels * ratio[k];
    }
    const double off = std::sin(angle - strongest);
    cost[step] = k_nearer * off * off;
    for (std::size_t k = 0; k < ratio.size(); ++k)
      if (ratio[k] > 0) cost[step] += local.pixels[k] / pixels * (ratio[k] / mean - std::log(ratio[k] / mean) - 1);
  }
  const auto best = static_cast<std::size_t>(std::min_element(cost.begin(), cost.end()) - cost.begin());
  LocalAxis axis{k_pi * static_cast<double>(best) / k_steps, 0};
  double sum = 0, squares = 0;
  for (std::size_t step = 0; step < k_steps; ++step) {
    const double likelihood = std::exp(-k_evidence * (cost[step] - cost[best]));
    const double off = std::remainder(k_pi * static_cast<double>(step) / k_steps - axis.angle, k_pi);
    sum += likelihood;
    squares += likelihood * off * off;
  }
  axis.deviation = std::sqrt(squares / sum);
  return axis;
}

/// Whether the relief has a direction of its own: one of its waves, or more of them along one direction than light
/// makes of an isotropic relief, while there are no four equal ones.
bool has_direction(const LocalGradients& local, const Harmonics& harmonics) {
  constexpr double k_one = 0.75, k_isotropic = 0.5, k_four = 0.55;
  return local.common > k_one || (local.common > k_isotropic && std::abs(harmonics.fourth) < k_four);
}

LightEstimate estimate(const GreyImage& image) {
  LightEstimate result;
  constexpr int k_least_px = 8;
  if (std::min(image.width, image.height) < k_least_px) return result;
  const Harmonics harmonics = harmonics_of(image);
  Axis axis = axis_of(harmonics);
  result.coherence = axis.coherence;
  if (!(result.coherence > 0)) return result;
  constexpr double k_isotropic_deg = 2, k_directed_deg = 30, k_least_deg = 1, k_unknown_deg = 52;
  const LocalGradients local = local_gradients(image);
  double spread = 0;
  if (has_direction(local, harmonics)) {
    const LocalAxis found = local_axis(local, std::arg(std::conj(harmonics.second)) / 2);
    axis.angle = found.angle;
    spread = found.deviation * k_degrees_per_radian;
  } else {
    // What the relief's own directions add: four of them leave two angles, other ones are taken for the light's.
    const double own = k_isotropic_deg + k_directed_deg * std::abs(harmonics.fourth);
    spread = std::hypot(jackknife(image, axis.angle) * k_degrees_per_radian, own);
  }
  result.uncertainty_deg = std::clamp(spread, k_least_deg, k_unknown_deg);
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
