// SPDX-License-Identifier: GPL-3.0-or-later
#include "papilla/texture/registration.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "bicubic.hpp"
#include "checks.hpp"
#include "fft.hpp"
#include "papilla/core/error.hpp"
#include "shaped_noise.hpp"

namespace papilla {
namespace {

using namespace texture_detail;
using Spectrum = std::vector<std::complex<double>>;

/// Spectrum of the logarithm without slow changes of the light, faded out towards the borders.
Spectrum spectrum_of(const GreyImage& image) {
  constexpr double k_darkest = 0.01, k_slow_px = 16;
  std::vector<double> field(image.pixels.size());
  std::transform(image.pixels.begin(), image.pixels.end(), field.begin(),
                 [&](float value) { return std::log(std::max(static_cast<double>(value), k_darkest)); });
  filter(field, image.width, image.height, false, [](double x, double y) {
    return 1 - std::exp(-2 * std::numbers::pi * std::numbers::pi * k_slow_px * k_slow_px * (x * x + y * y));
  });
  RealFft2d transform(image.width, image.height);
  const auto window = [](int i, int count) { return 0.5 - 0.5 * std::cos(2 * std::numbers::pi * (i + 0.5) / count); };
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      transform.real(x, y) = field[image.index(x, y)] * window(x, image.width) * window(y, image.height);
  transform.forward();
  return {transform.spectrum(),
          transform.spectrum() + transform.spectrum_width() * static_cast<std::size_t>(image.height)};
}

/// Offset of the maximum of a parabola through three values at −1, 0, 1.
double vertex(double before, double at, double after) {
  const double bend = 2 * at - before - after;
  return bend > 0 ? std::clamp((after - before) / (2 * bend), -0.5, 0.5) : 0;
}

/// Shift of the content of `second` against that of `first`; nothing where no peak stands out of chance. Grains that
/// repeat have peaks a cell apart: the nearer one is likelier.
std::optional<Vec2> shift_between(const Spectrum& first, const Spectrum& second, int width, int height, int largest) {
  constexpr double k_peak_px = 1, k_weakest = 1e-4;
  RealFft2d transform(width, height);
  const std::size_t columns = transform.spectrum_width();
  double strongest = 0;
  for (std::size_t i = 0; i < first.size(); ++i) strongest = std::max(strongest, std::abs(first[i] * second[i]));
  for (int v = 0; v < height; ++v)
    for (std::size_t u = 0; u < columns; ++u) {
      const std::size_t i = static_cast<std::size_t>(v) * columns + u;
      const std::complex<double> cross = std::conj(first[i]) * second[i];
      const double size = std::abs(cross), x = static_cast<double>(u) / width,
                   y = static_cast<double>(v <= height / 2 ? v : v - height) / height;
      const double low = std::exp(-2 * std::numbers::pi * std::numbers::pi * k_peak_px * k_peak_px * (x * x + y * y));
      const double trust = size / (size + k_weakest * strongest);
      transform.spectrum()[i] = size > 0 ? cross * cross / (size * size) * trust * low : 0;
    }
  transform.backward();
  const int reach = 2 * largest;
  int best_x = 0, best_y = 0;
  const auto likely = [&](int x, int y) {
    return transform.real(wrapped(x, width), wrapped(y, height)) /
           (1 + static_cast<double>(x * x + y * y) / (reach * reach));
  };
  const auto at = [&](int x, int y) { return transform.real(wrapped(x, width), wrapped(y, height)); };
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x)
      if (likely(x, y) > likely(best_x, best_y)) best_x = x, best_y = y;
  const double peak = at(best_x, best_y);
  double squares = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) squares += transform.real(x, y) * transform.real(x, y);
  constexpr double k_chance = 5;  // Deviations: four are the highest of ten thousand of noise.
  if (!(peak > k_chance * std::sqrt(squares / (static_cast<double>(width) * height)))) return {};
  const Vec2 twice{best_x + vertex(at(best_x - 1, best_y), peak, at(best_x + 1, best_y)),
                   best_y + vertex(at(best_x, best_y - 1), peak, at(best_x, best_y + 1))};
  const double most = largest;
  return Vec2{std::clamp(twice.x / 2, -most, most), std::clamp(twice.y / 2, -most, most)};
}

struct Pair {
  std::size_t first, second;
  Vec2 shift;
};

/// Shifts against the first photograph that fit those between pairs, by relaxation with Cauchy's weights.
std::vector<Vec2> reconcile(const std::vector<Pair>& pairs, std::size_t count, double& deviation) {
  constexpr double k_usual_px = 0.1;
  std::vector<Vec2> shifts(count);
  for (const Pair& pair : pairs)
    if (pair.first == 0) shifts[pair.second] = pair.shift;
  const auto weight_of = [&](const Pair& pair) {
    const double error = norm(shifts[pair.second] - shifts[pair.first] - pair.shift) / k_usual_px;
    return 1 / (1 + error * error);
  };
  for (int step = 0; step < 100; ++step)
    for (std::size_t k = 1; k < count; ++k) {
      Vec2 sum{};
      double weights = 0;
      for (const Pair& pair : pairs) {
        if (pair.first != k && pair.second != k) continue;
        const double weight = weight_of(pair);
        const Vec2 says = pair.second == k ? shifts[pair.first] + pair.shift : shifts[pair.second] - pair.shift;
        sum = sum + weight * says, weights += weight;
      }
      if (weights > 0) shifts[k] = (1 / weights) * sum;
    }
  std::vector<double> errors;
  for (const Pair& pair : pairs) errors.push_back(norm(shifts[pair.second] - shifts[pair.first] - pair.shift));
  std::sort(errors.begin(), errors.end());
  deviation = errors.empty() ? 0 : errors[errors.size() / 2];
  return shifts;
}

GreyImage moved(const GreyImage& image, Vec2 shift) {
  GreyImage result = image;
  const auto pixel = [&](int x, int y) {
    return image.at(std::clamp(x, 0, image.width - 1), std::clamp(y, 0, image.height - 1));
  };
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      result.at(x, y) = static_cast<float>(std::max(0.0, bicubic(x + shift.x, y + shift.y, pixel)));
  return result;
}

}  // namespace

Registration register_photographs(const std::vector<GreyImage>& photographs, int largest_shift_px) {
  if (photographs.empty() || largest_shift_px < 1)
    throw InvalidInput("register_photographs: there is no photograph, or the largest shift is below 1");
  const GreyImage& reference = photographs.front();
  std::vector<Spectrum> spectra;
  for (std::size_t k = 0; k < photographs.size(); ++k) {
    require_image(photographs[k], "register_photographs", 16);
    if (photographs[k].width != reference.width || photographs[k].height != reference.height)
      throw InvalidInput("register_photographs: photograph [" + std::to_string(k) + "] has another size than [0]");
    spectra.push_back(spectrum_of(photographs[k]));
  }
  const int largest = std::max(1, std::min(largest_shift_px, std::min(reference.width, reference.height) / 4 - 1));
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < spectra.size(); ++a)
    for (std::size_t b = a + 1; b < spectra.size(); ++b)
      if (const auto shift = shift_between(spectra[a], spectra[b], reference.width, reference.height, largest))
        pairs.push_back({a, b, *shift});
  Registration result;
  result.shifts_px = reconcile(pairs, photographs.size(), result.disagreement_px);
  constexpr double k_most_disagreement_px = 1;  // Shifts that contradict each other are chance.
  if (result.disagreement_px > k_most_disagreement_px) result.shifts_px.assign(photographs.size(), Vec2{});
  for (std::size_t k = 0; k < photographs.size(); ++k)
    result.photographs.push_back(norm(result.shifts_px[k]) > 0 ? moved(photographs[k], result.shifts_px[k])
                                                               : photographs[k]);
  return result;
}

}  // namespace papilla
