// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "papilla/texture/stein_surface.hpp"

namespace papilla::test {

/// An exact surface as a camera would show it.
struct SeenSurface {
  double dimension = 2.5;
  int side = 257;
  std::uint64_t seed = 1;
  double spread_px = 0;  ///< σ of the Gaussian, by convolution in space.
  double noise = 0;      ///< σ of white noise over the picture's range of grey values.
  int bits = 8;
  int finer = 1;            ///< Samples of the surface a pixel: with 1 the blur comes after sampling.
  bool pixel_area = false;  ///< A pixel is the mean over its area, not a sample.
};

/// Convolution with the sampled Gaussian to 5 σ; borders reflect.
inline std::vector<double> blurred(std::span<const double> z, int side, double spread) {
  if (!(spread > 0)) return {z.begin(), z.end()};
  const int reach = static_cast<int>(std::ceil(5 * spread));
  std::vector<double> weights;
  double sum = 0;
  for (int k = -reach; k <= reach; ++k) sum += weights.emplace_back(std::exp(-k * k / (2 * spread * spread)));
  const auto at = [side](int i) { return i < 0 ? -1 - i : i >= side ? 2 * side - 1 - i : i; };
  const auto index = [side](int x, int y) { return static_cast<std::size_t>(y * side + x); };
  std::vector<double> across(z.size()), result(z.size());
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      for (int k = -reach; k <= reach; ++k)
        across[index(x, y)] += weights[static_cast<std::size_t>(k + reach)] / sum * z[index(at(x + k), y)];
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      for (int k = -reach; k <= reach; ++k)
        result[index(x, y)] += weights[static_cast<std::size_t>(k + reach)] / sum * across[index(x, at(y + k))];
  return result;
}

/// Normal deviates, the same with every standard library.
inline double normal_deviate(std::mt19937_64& random) {
  const double u = (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53;
  const double v = static_cast<double>(random() >> 11) * 0x1p-53;
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

inline GreyImage seen_surface(const SeenSurface& how) {
  const int fine = how.side * how.finer;
  const HeightGrid surface = brownian_surface_exact({fine, 3 - how.dimension, how.seed});
  const std::vector<double> z = blurred(surface.heights, fine, how.spread_px * how.finer);
  HeightGrid seen{how.side, {}, false};
  for (int y = 0; y < how.side; ++y)
    for (int x = 0; x < how.side; ++x) {
      const int reach = how.pixel_area ? how.finer : 1;
      double sum = 0;
      for (int j = 0; j < reach; ++j)
        for (int i = 0; i < reach; ++i)
          sum += z[static_cast<std::size_t>(y * how.finer + j) * static_cast<std::size_t>(fine) +
                   static_cast<std::size_t>(x * how.finer + i)];
      seen.heights.push_back(sum / (reach * reach));
    }
  GreyImage image = to_grey_image(seen);
  image.bits = how.bits;
  std::mt19937_64 random(7919 * how.seed + 1);
  for (float& grey : image.pixels) {
    double value = static_cast<double>(grey);
    if (how.noise > 0) value += how.noise * normal_deviate(random);
    if (how.bits == 8) value = std::round(255 * std::clamp(value, 0.0, 1.0)) / 255;
    grey = static_cast<float>(value);
  }
  return image;
}

}  // namespace papilla::test
