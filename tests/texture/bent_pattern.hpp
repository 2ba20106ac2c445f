// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <numbers>

#include "papilla/core/vec.hpp"
#include "texture/fixtures.hpp"

namespace papilla::test {

inline constexpr Vec2 k_a{21, 4}, k_b{-6, 17};

/// A pattern of waves on the lattice of k_a and k_b, with the amplitudes 0.12, 0.1, 0.08 and 0.06.
inline double pattern(Vec2 p) {
  const double area = cross(k_a, k_b);
  const double u = 2 * std::numbers::pi * cross(p, k_b) / area, v = 2 * std::numbers::pi * cross(k_a, p) / area;
  return 0.5 + 0.12 * std::cos(u) + 0.1 * std::sin(v + 0.7) + 0.08 * std::cos(u - v + 1) + 0.06 * std::sin(2 * u + v);
}

/// A displacement with no linear part to speak of: waves over the oblong picture of 210 × 150 pixels.
inline Vec2 bend(double x, double y) {
  const double p = 2 * std::numbers::pi * x / 210, q = 2 * std::numbers::pi * y / 150;
  return {1.8 * std::cos(p) * std::cos(q), -1.5 * std::cos(p + q)};
}

/// The pattern displaced by `amount` times bend().
inline GreyImage bent_pattern(double amount) {
  return make_image(210, 150, [=](int x, int y) {
    const Vec2 u = amount * bend(x, y);
    return pattern({x + u.x, y + u.y});
  });
}

/// Root mean square of what changes from a place to the one at k_a + k_b, over that of the grey values.
inline double irregularity(const GreyImage& image) {
  constexpr int k_right = 15, k_down = 21, k_rim = 8;
  double squares = 0, sum = 0, deviations = 0;
  int count = 0;
  const auto each = [&](const auto& visit) {
    for (int y = k_rim; y < image.height - k_down - k_rim; ++y)
      for (int x = k_rim; x < image.width - k_right - k_rim; ++x) visit(x, y);
  };
  each([&](int x, int y) { sum += static_cast<double>(image.at(x, y)), ++count; });
  each([&](int x, int y) {
    const auto here = static_cast<double>(image.at(x, y));
    squares += std::pow(here - static_cast<double>(image.at(x + k_right, y + k_down)), 2);
    deviations += std::pow(here - sum / count, 2);
  });
  return std::sqrt(squares / deviations);
}

}  // namespace papilla::test
