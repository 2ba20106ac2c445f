// SPDX-License-Identifier: MIT
#include "pictures/mip_pyramid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include "papilla/core/srgb.hpp"

namespace papilla {
namespace {

std::size_t offset(int width, int x, int y) {
  return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
}

int wrapped(int i, int n) { return ((i % n) + n) % n; }

}  // namespace

MipPyramid::MipPyramid(const ColorImage& image, bool encoded_srgb) {
  std::array<float, 256> decode{};
  for (int i = 0; i < 256; ++i) {
    const double c = i / 255.0;
    decode[static_cast<std::size_t>(i)] = static_cast<float>(encoded_srgb ? linear_from_srgb(c) : c);
  }
  Level base{image.width, image.height, std::vector<float>(image.pixels.size())};
  std::transform(image.pixels.begin(), image.pixels.end(), base.rgb.begin(),
                 [&](unsigned char c) { return decode[c]; });
  levels_.push_back(std::move(base));
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& fine = levels_.back();
    Level coarse{std::max(1, fine.width / 2), std::max(1, fine.height / 2), {}};
    coarse.rgb.resize(offset(coarse.width, 0, coarse.height));
    for (int y = 0; y < coarse.height; ++y) {
      for (int x = 0; x < coarse.width; ++x) {
        const int x0 = std::min(2 * x, fine.width - 1), x1 = std::min(2 * x + 1, fine.width - 1);
        const int y0 = std::min(2 * y, fine.height - 1), y1 = std::min(2 * y + 1, fine.height - 1);
        for (std::size_t c = 0; c < 3; ++c)
          coarse.rgb[offset(coarse.width, x, y) + c] =
              0.25F * (fine.rgb[offset(fine.width, x0, y0) + c] + fine.rgb[offset(fine.width, x1, y0) + c] +
                       fine.rgb[offset(fine.width, x0, y1) + c] + fine.rgb[offset(fine.width, x1, y1) + c]);
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

Vec3 MipPyramid::sample(Vec2 uv, double texels) const {
  const double lod = 0.5 * std::log2(std::max(texels, 1.0));
  const auto number = static_cast<std::size_t>(std::clamp(std::lround(lod), 0L, static_cast<long>(levels_.size()) - 1));
  const Level& level = levels_[number];
  const double x = (uv.x - std::floor(uv.x)) * level.width - 0.5,
               y = (1 - (uv.y - std::floor(uv.y))) * level.height - 0.5;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const double fx = x - x0, fy = y - y0;
  std::array<double, 3> sum{};
  for (const auto& [dx, dy, weight] : {std::tuple{0, 0, (1 - fx) * (1 - fy)}, std::tuple{1, 0, fx * (1 - fy)},
                                       std::tuple{0, 1, (1 - fx) * fy}, std::tuple{1, 1, fx * fy}}) {
    const float* texel = &level.rgb[offset(level.width, wrapped(x0 + dx, level.width), wrapped(y0 + dy, level.height))];
    for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * static_cast<double>(texel[c]);
  }
  return {sum[0], sum[1], sum[2]};
}

}  // namespace papilla
