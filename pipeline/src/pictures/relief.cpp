// SPDX-License-Identifier: MIT
#include "pictures/relief.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "papilla/core/vec.hpp"

namespace papilla {
namespace {

int neighbour(int i, int n, bool periodic) {
  if (periodic) return (i + n) % n;
  return std::clamp(i, 0, n - 1);
}

/// Central differences in mm/mm; y grows downwards.
Vec2 slope(const HeightMap& map, int x, int y) {
  const int x0 = neighbour(x - 1, map.width, map.periodic), x1 = neighbour(x + 1, map.width, map.periodic);
  const int y0 = neighbour(y - 1, map.height, map.periodic), y1 = neighbour(y + 1, map.height, map.periodic);
  return {static_cast<double>(map.at(x1, y) - map.at(x0, y)) / (2 * map.pitch_mm_x),
          static_cast<double>(map.at(x, y1) - map.at(x, y0)) / (2 * map.pitch_mm_y)};
}

}  // namespace

ColorImage draw_relief(const HeightMap& map, double& exaggeration) {
  constexpr double k_visible_rms_slope = 0.25;
  std::vector<Vec2> slopes;
  slopes.reserve(map.mm.size());
  double sum = 0;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      slopes.push_back(slope(map, x, y));
      sum += dot(slopes.back(), slopes.back());
    }
  const double rms = slopes.empty() ? 0 : std::sqrt(sum / static_cast<double>(slopes.size()));
  exaggeration = rms > 0 ? std::max(1.0, k_visible_rms_slope / rms) : 1;

  const Vec3 light = normalized(Vec3{-1, -1, std::sqrt(2.0) * std::tan(0.61)});  // y downwards: from the top left
  ColorImage image{map.width, map.height, {}};
  image.pixels.reserve(3 * slopes.size());
  for (const Vec2 s : slopes) {
    const Vec3 normal = normalized(Vec3{-exaggeration * s.x, -exaggeration * s.y, 1});
    const double brightness = 0.12 + 0.88 * std::max(0.0, dot(normal, light));
    const auto grey = static_cast<unsigned char>(std::lround(255 * std::pow(std::min(1.0, brightness), 1 / 2.2)));
    image.pixels.insert(image.pixels.end(), {grey, grey, grey});
  }
  return image;
}

double draw_scale_bar(ColorImage& picture, double pitch_mm) {
  constexpr int k_least_side = 48;
  if (std::min(picture.width, picture.height) < k_least_side || !(pitch_mm > 0)) return 0;
  const double most_mm = picture.width * pitch_mm / 3, power = std::pow(10, std::floor(std::log10(most_mm)));
  const double length_mm = power * (most_mm >= 5 * power ? 5 : most_mm >= 2 * power ? 2 : 1);
  const int length = std::max(1, static_cast<int>(std::lround(length_mm / pitch_mm)));
  const int unit = std::max(1, picture.height / 128), left = 3 * unit, bottom = picture.height - 3 * unit;
  for (int y = bottom - 4 * unit; y < bottom; ++y)
    for (int x = left; x < std::min(picture.width, left + length + 2 * unit); ++x) {
      const bool inside = y >= bottom - 3 * unit && y < bottom - unit && x >= left + unit && x < left + unit + length;
      const auto at =
          3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x));
      for (std::size_t c = 0; c < 3; ++c) picture.pixels[at + c] = inside ? 255 : 0;
    }
  return length_mm;
}

}  // namespace papilla
