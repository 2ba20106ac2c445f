// SPDX-License-Identifier: GPL-3.0-or-later
#include "weather/own_colour.hpp"

#include <algorithm>
#include <cmath>

#include "papilla/io/image_file.hpp"

namespace papilla::app {

OwnColour::OwnColour(const Scene& scene, const Material& material) {
  for (std::size_t k = 0; k < 3; ++k)
    tint_[k] = static_cast<float>(std::pow(std::clamp(material.base_color[k], 0.0, 1.0), 1 / 2.2));
  if (!material.base_color_texture) return;
  if (const auto image = scene.textures[material.base_color_texture->texture].image)
    picture_ = decode_color_image(scene.images[*image].bytes, scene.images[*image].name);
}

std::array<float, 3> OwnColour::at(double u, double v) const {
  if (!picture_) return tint_;
  const double x = (u - std::floor(u)) * picture_->width - 0.5, y = (v - std::floor(v)) * picture_->height - 0.5;
  const double left = std::floor(x), top = std::floor(y), s = x - left, t = y - top;
  const auto pixel = [&](double column, double row) {
    const auto wrapped = [](double i, int n) { return static_cast<std::size_t>((static_cast<int>(i) + n) % n); };
    return 3 * (wrapped(row, picture_->height) * static_cast<std::size_t>(picture_->width) +
                wrapped(column, picture_->width));
  };
  const std::array<std::size_t, 4> at{pixel(left, top), pixel(left + 1, top), pixel(left, top + 1),
                                      pixel(left + 1, top + 1)};
  const std::array<double, 4> share{(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t};
  std::array<float, 3> out{};
  for (std::size_t k = 0; k < 3; ++k) {
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) sum += share[i] * picture_->pixels[at[i] + k];
    out[k] = static_cast<float>(sum / 255) * tint_[k];
  }
  return out;
}

}  // namespace papilla::app
