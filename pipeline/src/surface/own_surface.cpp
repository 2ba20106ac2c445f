// SPDX-License-Identifier: MIT
#include "surface/own_surface.hpp"

#include <algorithm>
#include <cmath>

#include "papilla/io/image_file.hpp"
#include "papilla/texture/relief_of_normals.hpp"

namespace papilla {
namespace {

/// Green and blue of glTF's metallic-roughness picture.
constexpr std::array<std::size_t, 2> k_shine_channels{1, 2};

std::optional<std::uint32_t> image_of(const Scene& scene, const std::optional<TextureReference>& reference) {
  return reference ? scene.textures[reference->texture].image : std::nullopt;
}

std::optional<RgbaImage> picture_of(const Scene& scene, const std::optional<TextureReference>& reference) {
  const auto image = image_of(scene, reference);
  if (!image) return std::nullopt;
  return decode_rgba_image(scene, *image);
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
  /// Channel k in [0, 1].
  double of(const RgbaImage& picture, std::size_t k) const {
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) sum += share[i] * picture.pixels[4 * at[i] + k];
    return sum / 255;
  }
};

double mean_of(const RgbaImage& picture, std::size_t k) {
  double sum = 0;
  for (std::size_t i = k; i < picture.pixels.size(); i += 4) sum += picture.pixels[i];
  return sum / 255 / (static_cast<double>(picture.pixels.size()) / 4);
}

}  // namespace

const TextureReference* own_place(const Material& material) {
  for (const auto* reference :
       {&material.base_color_texture, &material.normal_texture, &material.metallic_roughness_texture})
    if (*reference) return &**reference;
  return nullptr;
}

OwnSurface::OwnSurface(const Scene& scene, const Material& material, double mm_per_repeat)
    : is_opaque_(material.alpha_mode == "OPAQUE") {
  for (std::size_t k = 0; k < 3; ++k)
    tint_[k] = static_cast<float>(std::pow(std::clamp(material.base_color[k], 0.0, 1.0), 1 / 2.2));
  tint_[3] = static_cast<float>(std::clamp(material.base_color[3], 0.0, 1.0));
  picture_ = picture_of(scene, material.base_color_texture);
  shine_ = {static_cast<float>(std::clamp(material.roughness, 0.0, 1.0)),
            static_cast<float>(std::clamp(material.metallic, 0.0, 1.0))};
  shine_picture_ = picture_of(scene, material.metallic_roughness_texture);
  if (shine_picture_ && !same_place(*material.metallic_roughness_texture, *own_place(material))) {
    for (std::size_t k = 0; k < 2; ++k) shine_[k] *= static_cast<float>(mean_of(*shine_picture_, k_shine_channels[k]));
    shine_picture_.reset();
    means_shine_ = true;
  }
  if (!material.normal_texture || !same_place(*material.normal_texture, *own_place(material))) return;
  if (const auto image = image_of(scene, material.normal_texture)) {
    const ColorImage normals = decode_image(scene, *image);
    relief_ = relief_of_normals(normals, material.normal_texture->factor, mm_per_repeat / normals.width,
                                mm_per_repeat / normals.height);
  }
}

std::array<float, 4> OwnSurface::colour_at(double u, double v) const {
  std::array<float, 4> out = tint_;
  if (picture_) {
    const Bilinear around(picture_->width, picture_->height, u, v);
    for (std::size_t k = 0; k < 4; ++k) out[k] *= static_cast<float>(around.of(*picture_, k));
  }
  if (is_opaque_) out[3] = 1;
  return out;
}

std::array<float, 2> OwnSurface::shine_at(double u, double v) const {
  std::array<float, 2> out = shine_;
  if (!shine_picture_) return out;
  const Bilinear around(shine_picture_->width, shine_picture_->height, u, v);
  for (std::size_t k = 0; k < 2; ++k) out[k] *= static_cast<float>(around.of(*shine_picture_, k_shine_channels[k]));
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
