// SPDX-License-Identifier: MIT
#include "papilla/texture/shading.hpp"

#include <algorithm>
#include <cmath>

#include "checks.hpp"
#include "slopes.hpp"

namespace papilla {

GreyImage render_lambert(const HeightMap& relief, Vec3 light) {
  texture_detail::require_height_map(relief, "render_lambert", true);
  const Vec3 s = texture_detail::require_light(light, "render_lambert");
  GreyImage picture{relief.width, relief.height, {}, 0, 32};
  picture.pixels.reserve(relief.mm.size());
  constexpr double k_same_pitch = 1e-9;
  if (std::abs(relief.pitch_mm_x - relief.pitch_mm_y) <= k_same_pitch * relief.pitch_mm_x)
    picture.pitch_mm = relief.pitch_mm_x;
  for (int y = 0; y < relief.height; ++y)
    for (int x = 0; x < relief.width; ++x) {
      const Vec2 g = texture_detail::slope(relief, x, y);
      const double cosine = (s.z - s.x * g.x - s.y * g.y) / std::sqrt(1 + dot(g, g));
      picture.pixels.push_back(static_cast<float>(std::max(0.0, cosine)));
    }
  return picture;
}

}  // namespace papilla
