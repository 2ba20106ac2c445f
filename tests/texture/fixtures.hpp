// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <functional>
#include <random>

#include "papilla/texture/height_map.hpp"
#include "papilla/texture/image.hpp"

namespace papilla::test {

/// A picture by formula.
inline GreyImage make_image(int width, int height, const std::function<double(int, int)>& value, int bits = 32) {
  GreyImage image{width, height, {}, 0, bits};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.pixels.push_back(static_cast<float>(value(x, y)));
  return image;
}

/// A picture of independent random grey values, on the 8-bit grid when bits = 8.
inline GreyImage noise_image(int width, int height, unsigned seed, int bits = 32) {
  std::mt19937 engine(seed);
  return make_image(
      width, height,
      [&](int, int) {
        return bits == 8 ? static_cast<double>(engine() >> 24) / 255 : static_cast<double>(engine()) / 4294967296.0;
      },
      bits);
}

/// A relief by formula with square pixels.
inline HeightMap make_relief(int width, int height, double pitch_mm, const std::function<double(int, int)>& mm) {
  HeightMap map{width, height, {}, pitch_mm, pitch_mm, true};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) map.mm.push_back(static_cast<float>(mm(x, y)));
  return map;
}

}  // namespace papilla::test
