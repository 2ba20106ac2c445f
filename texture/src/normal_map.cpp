// SPDX-License-Identifier: MIT
#include "papilla/texture/normal_map.hpp"

#include <cmath>

#include "checks.hpp"
#include "slopes.hpp"

namespace papilla {

ColorImage normal_map(const HeightMap& relief) {
  texture_detail::require_height_map(relief, "normal_map", true);
  ColorImage picture{relief.width, relief.height, {}};
  picture.pixels.reserve(3 * relief.mm.size());
  const auto byte = [](double component) { return static_cast<unsigned char>(std::lround(127.5 * (component + 1))); };
  for (int y = 0; y < relief.height; ++y)
    for (int x = 0; x < relief.width; ++x) {
      const Vec2 g = texture_detail::slope(relief, x, y);
      const Vec3 normal = normalized(Vec3{-g.x, g.y, 1});
      for (const double component : {normal.x, normal.y, normal.z}) picture.pixels.push_back(byte(component));
    }
  return picture;
}

}  // namespace papilla
