// SPDX-License-Identifier: MIT
#include "pictures/mip_pyramid.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "papilla/core/srgb.hpp"

namespace papilla {
namespace {

constexpr int k_clamp = 33071;  // glTF's wrap mode.

std::size_t offset(int width, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

int placed(int i, int n, bool clamped) { return clamped ? std::clamp(i, 0, n - 1) : ((i % n) + n) % n; }

}  // namespace

MipPyramid::MipPyramid(const RgbaImage& image, bool encoded_srgb, std::array<bool, 2> clamped) : clamped_(clamped) {
  std::array<float, 256> decode{};
  for (int i = 0; i < 256; ++i) {
    const double c = i / 255.0;
    decode[static_cast<std::size_t>(i)] = static_cast<float>(encoded_srgb ? linear_from_srgb(c) : c);
  }
  const std::size_t pixels = image.pixels.size() / 4;
  Level base{image.width, image.height, std::vector<float>(3 * pixels), {}};
  const bool with_alpha = papilla::has_alpha(image);
  if (with_alpha) base.alpha.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const float alpha = static_cast<float>(image.pixels[4 * i + 3]) / 255;
    for (std::size_t c = 0; c < 3; ++c)
      base.rgb[3 * i + c] = with_alpha ? alpha * decode[image.pixels[4 * i + c]] : decode[image.pixels[4 * i + c]];
    if (with_alpha) base.alpha[i] = alpha;
  }
  levels_.push_back(std::move(base));
  while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(halved(levels_.back()));
}

MipPyramid::Level MipPyramid::halved(const Level& fine) {
  Level coarse{std::max(1, fine.width / 2), std::max(1, fine.height / 2), {}, {}};
  const std::size_t pixels = offset(coarse.width, 0, coarse.height);
  coarse.rgb.resize(3 * pixels);
  if (!fine.alpha.empty()) coarse.alpha.resize(pixels);
  for (int y = 0; y < coarse.height; ++y) {
    for (int x = 0; x < coarse.width; ++x) {
      const int x0 = std::min(2 * x, fine.width - 1), x1 = std::min(2 * x + 1, fine.width - 1);
      const int y0 = std::min(2 * y, fine.height - 1), y1 = std::min(2 * y + 1, fine.height - 1);
      const auto mean = [&](const std::vector<float>& values, std::size_t channels, std::size_t c) {
        return 0.25F *
               (values[channels * offset(fine.width, x0, y0) + c] + values[channels * offset(fine.width, x1, y0) + c] +
                values[channels * offset(fine.width, x0, y1) + c] + values[channels * offset(fine.width, x1, y1) + c]);
      };
      const std::size_t at = offset(coarse.width, x, y);
      for (std::size_t c = 0; c < 3; ++c) coarse.rgb[3 * at + c] = mean(fine.rgb, 3, c);
      if (!coarse.alpha.empty()) coarse.alpha[at] = mean(fine.alpha, 1, 0);
    }
  }
  return coarse;
}

MipPyramid::Texel MipPyramid::sample(Vec2 uv, double texels) const {
  const double lod = 0.5 * std::log2(std::max(texels, 1.0));
  const auto number = static_cast<std::size_t>(std::clamp(std::lround(lod), 0L, static_cast<long>(levels_.size()) - 1));
  const Level& level = levels_[number];
  const double u = clamped_[0] ? std::clamp(uv.x, 0.0, 1.0) : uv.x - std::floor(uv.x);
  const double v = clamped_[1] ? std::clamp(uv.y, 0.0, 1.0) : uv.y - std::floor(uv.y);
  const double x = u * level.width - 0.5, y = (1 - v) * level.height - 0.5;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const double fx = x - x0, fy = y - y0;
  std::array<double, 3> sum{};
  double alpha = 0;
  for (const auto& [dx, dy, weight] : {std::tuple{0, 0, (1 - fx) * (1 - fy)}, std::tuple{1, 0, fx * (1 - fy)},
                                       std::tuple{0, 1, (1 - fx) * fy}, std::tuple{1, 1, fx * fy}}) {
    const std::size_t at =
        offset(level.width, placed(x0 + dx, level.width, clamped_[0]), placed(y0 + dy, level.height, clamped_[1]));
    for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * static_cast<double>(level.rgb[3 * at + c]);
    if (has_alpha()) alpha += weight * static_cast<double>(level.alpha[at]);
  }
  const Vec3 color{sum[0], sum[1], sum[2]};
  if (!has_alpha()) return {color, 1};
  return {alpha > 0 ? (1 / alpha) * color : Vec3{}, alpha};
}

std::shared_ptr<const MipPyramid> Pyramids::get(const std::optional<TextureReference>& reference, bool color) {
  if (!reference || reference->texture >= scene_.textures.size() || reference->tex_coord > 1) return nullptr;
  const Texture& texture = scene_.textures[reference->texture];
  if (!texture.image || *texture.image >= scene_.images.size()) return nullptr;
  auto& slot = (color ? color_ : raw_)[reference->texture];
  if (!slot)
    slot = std::make_shared<MipPyramid>(decode_rgba_image(scene_, *texture.image), color,
                                        std::array{texture.wrap_s == k_clamp, texture.wrap_t == k_clamp});
  return slot;
}

}  // namespace papilla
