// SPDX-License-Identifier: MIT
#include "papilla/procedural/preview.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "node.hpp"

namespace papilla {
namespace {

using Direction = std::array<double, 3>;

/// A light nearer than this many sides of the picture is no brighter.
constexpr double k_least_distance = 1e-2;

double dot(const Direction& a, const Direction& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Direction scaled_to(Direction v, double length) {
  const double norm = std::sqrt(dot(v, v));
  for (double& c : v) c = norm > 0 ? c / norm * length : 0;
  return v;
}

/// Change of the bump channel a texel, across and down.
struct Slopes {
  std::vector<double> across, down;
};

Slopes slopes_of_neighbours(const RenderedTexture& rendered) {
  const std::vector<float>& bump = rendered.values[Channel::bump];
  const int w = rendered.width, h = rendered.height;
  const auto at = [&](int x, int y) {
    return static_cast<double>(bump[static_cast<std::size_t>((y + h) % h) * static_cast<std::size_t>(w) +
                                    static_cast<std::size_t>((x + w) % w)]);
  };
  Slopes slopes;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      slopes.across.push_back((at(x + 1, y) - at(x - 1, y)) / 2);
      slopes.down.push_back((at(x, y + 1) - at(x, y - 1)) / 2);
    }
  return slopes;
}

/// From the heights half a texel to either side.
Slopes slopes_within_texels(const ProceduralTexture& texture, const RenderedTexture& rendered) {
  const auto heights = [&](double shift_x, double shift_y) {
    RenderOptions options;
    options.width = rendered.width, options.height = rendered.height;
    options.shift_x = shift_x, options.shift_y = shift_y;
    options.channels = 1U << static_cast<unsigned>(Channel::bump);
    return std::move(render_texture(texture, options).values.channels[static_cast<std::size_t>(Channel::bump)]);
  };
  const auto change = [&](double shift_x, double shift_y) {
    const std::vector<float> before = heights(-shift_x, -shift_y), behind = heights(shift_x, shift_y);
    std::vector<double> slopes;
    for (std::size_t i = 0; i < before.size(); ++i) slopes.push_back(static_cast<double>(behind[i] - before[i]));
    return slopes;
  };
  return {change(0.5, 0), change(0, 0.5)};
}

}  // namespace

PreviewLight preview_light(const ProceduralTexture& texture) noexcept {
  return texture.graph().nodes[static_cast<std::size_t>(texture.graph().root)]->light;
}

std::vector<float> light_texture(const ProceduralTexture& texture, const RenderedTexture& rendered, double relief) {
  const PreviewLight light = preview_light(texture);
  std::vector<float> picture = rendered.values[Channel::color];
  if (!light.shade) return picture;
  const Slopes slopes =
      light.from_neighbours ? slopes_of_neighbours(rendered) : slopes_within_texels(texture, rendered);
  const double side = std::min(rendered.width, rendered.height);
  const Direction place{(0.5 + light.x / 2) * rendered.width, -(0.5 - light.y / 2) * rendered.height, light.z * side};
  for (int y = 0; y < rendered.height; ++y)
    for (int x = 0; x < rendered.width; ++x) {
      const std::size_t i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(rendered.width) + static_cast<std::size_t>(x);
      const auto value = [&](Channel c) { return static_cast<double>(rendered.values[c][i]); };
      const Direction normal = scaled_to({-relief * slopes.across[i], relief * slopes.down[i], 1}, 1);
      Direction to_light{light.x, light.y, light.z};
      double strength = light.scale;
      if (light.at_a_point) {
        to_light = {place[0] - x - 0.5, place[1] + y + 0.5, place[2] - relief * value(Channel::bump)};
        const double distance = std::max(std::sqrt(dot(to_light, to_light)) / side, k_least_distance);
        if (light.falls) strength /= distance * distance;
      }
      to_light = scaled_to(to_light, 1);
      const double facing = std::max(0.0, dot(normal, to_light));
      const double mirrored = std::max(0.0, 2 * facing * normal[2] - to_light[2]);
      const double glossy = facing > 0 ? strength * value(Channel::specular) *
                                             std::pow(mirrored, std::max(0.0, value(Channel::specularcoeff)))
                                       : 0;
      const double matt = light.ambient + strength * value(Channel::diffuse) * facing;
      for (std::size_t k = 3 * i; k < 3 * i + 3; ++k)
        picture[k] = static_cast<float>(std::clamp(static_cast<double>(picture[k]) * matt + glossy, 0.0, 1.0));
    }
  return picture;
}

}  // namespace papilla
