// SPDX-License-Identifier: MIT
#include "weather/own_surface.hpp"

#include <algorithm>
#include <cmath>

#include "papilla/io/image_file.hpp"
#include "papilla/texture/relief_of_normals.hpp"

namespace papilla {
namespace {

std::optional<ColorImage> picture_of(const Scene& scene, const std::optional<TextureReference>& reference) {
  if (!reference) return std::nullopt;
  const auto image = scene.textures[reference->texture].image;
  if (!image) return std::nullopt;
  return decode_color_image(scene.images[*image].bytes, scene.images[*image].name);
}

bool same_place(const TextureReference& a, const TextureReference& b) {
  return a.tex_coord == b.tex_coord && a.transform == b.transform;
}

/// The four texels around a place of a repeating picture, and their shares.
struct Bilinear {
  std::array<std::size_t, 4> at;
  std::array<double, 4> share;
  Bilinear(int width, int height, double u, double v) {
    const double x = (u - std::floor(u)) * width - 0.5, y = (v - std::floor(v)) * height - 0.5;
    const double left = std::floor(x), top = std::floor(y), s = x - left, t = y - top;
    const auto index = [&](double column, double row) {
      const auto wrapped = [](double i, int n) { return static_cast<std::size_t>((static_cast<int>(i) + n) % n); };
      return wrapped(row, height) * static_cast<std::size_t>(width) + wrapped(column, width);
    };
    at = {index(left, top), index(left + 1, top), index(left, top + 1), index(left + 1, top + 1)};
    share = {(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t};
  }
};

}  // namespace

const TextureReference* own_place(const Material& material) {
  if (material.base_color_texture) return &*material.base_color_texture;
  return material.normal_texture ? &*material.normal_texture : nullptr;
}

OwnSurface::OwnSurface(const Scene& scene, const Material& material, double mm_per_repeat) {
  for (std::size_t k = 0; k < 3; ++k)
    tint_[k] = static_cast<float>(std::pow(std::clamp(material.base_color[k], 0.0, 1.0), 1 / 2.2));
  picture_ = picture_of(scene, material.base_color_texture);
  if (!material.normal_texture || !same_place(*material.normal_texture, *own_place(material))) return;
  if (const auto normals = picture_of(scene, material.normal_texture))
    relief_ = relief_of_normals(*normals, material.normal_texture->factor, mm_per_repeat / normals->width,
                                mm_per_repeat / normals->height);
}

std::array<float, 3> OwnSurface::colour_at(double u, double v) const {
  if (!picture_) return tint_;
  const Bilinear around(picture_->width, picture_->height, u, v);
  std::array<float, 3> out{};
  for (std::size_t k = 0; k < 3; ++k) {
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) sum += around.share[i] * picture_->pixels[3 * around.at[i] + k];
    out[k] = static_cast<float>(sum / 255) * tint_[k];
  }
  return out;
}

float OwnSurface::height_at(double u, double v) const {
  if (!relief_) return 0;
  const Bilinear around(relief_->width, relief_->height, u, v);
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) sum += around.share[i] * static_cast<double>(relief_->mm[around.at[i]]);
  return static_cast<float>(sum);
}

}  // namespace papilla
