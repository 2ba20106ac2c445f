// SPDX-License-Identifier: MIT
#include "evaluate/extreme_pictures.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <random>

#include "papilla/texture/stein_surface.hpp"

namespace papilla {
namespace {

constexpr int k_side = 128, k_fractal_side = 129;

template <class Grey>
GreyImage picture(int width, int height, int bits, Grey&& grey) {
  GreyImage image{width, height, Values<float>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)), 0,
                  bits};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.at(x, y) = static_cast<float>(grey(x, y));
  return image;
}

GreyImage flat(double grey) {
  return picture(k_side, k_side, 8, [=](int, int) { return grey; });
}

GreyImage noise(bool one_bit) {
  std::mt19937 random(1);
  return picture(k_side, k_side, 8, [&](int, int) {
    const double value = static_cast<double>(random() >> 24U) / 255;
    return one_bit ? std::round(value) : value;
  });
}

GreyImage fractal(double hurst, int size) {
  BrownianSurfaceOptions options;
  options.size = size;
  options.hurst = hurst;
  return to_grey_image(brownian_surface_exact(options));
}

/// A square lattice of cosine bumps plus noise of `sigma` times the signal's standard deviation.
GreyImage lattice(double period, double sigma) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 1);
  return picture(k_side, k_side, 32, [&](int x, int y) {
    const double signal =
        0.25 * (std::cos(2 * std::numbers::pi * x / period) + std::cos(2 * std::numbers::pi * y / period));
    return 0.5 + 0.2 * (signal + 0.25 * sigma * normal(random));
  });
}

}  // namespace

std::vector<NamedPicture> extreme_pictures() {
  std::vector<NamedPicture> all;
  all.push_back({"fractal, H = 0.5", fractal(0.5, k_fractal_side), 2.5, 0});
  for (const double hurst : {0.01, 0.1, 0.9, 0.99})
    all.push_back({fmt::format("fractal, H = {:g}", hurst), fractal(hurst, k_fractal_side), 3 - hurst, 0});
  all.push_back({"flat", flat(0.5), 2, 0});
  all.push_back({"black", flat(0), 2, 0});
  all.push_back({"white", flat(1), 2, 0});
  all.push_back({"noise", noise(false), 3, 0});
  all.push_back({"noise of one bit", noise(true), std::nullopt, 0});
  all.push_back({"one white pixel", picture(k_side, k_side, 8, [](int x, int y) { return x == 64 && y == 64 ? 1 : 0; }),
                 std::nullopt, 0});
  all.push_back({"lattice of 16 px", lattice(16, 0), std::nullopt, 16});
  all.push_back({"lattice of 16 px, noise 1 σ", lattice(16, 1), std::nullopt, 16});
  all.push_back({"lattice of 16 px, noise 4 σ", lattice(16, 4), std::nullopt, 16});
  all.push_back({"lattice of 2 px", lattice(2, 0), std::nullopt, 2});
  all.push_back({"one pixel", picture(1, 1, 8, [](int, int) { return 0.5; }), std::nullopt, std::nullopt});
  all.push_back({"one row", picture(k_side, 1, 8, [](int x, int) { return x % 8 / 8.0; }), std::nullopt, std::nullopt});
  all.push_back({"not a number", picture(k_side, k_side, 32, [](int x, int) { return x == 3 ? std::nan("") : 0.5; }),
                 std::nullopt, std::nullopt});
  return all;
}

}  // namespace papilla
