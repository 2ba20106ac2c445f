// SPDX-License-Identifier: MIT
#include "papilla/texture/box_dimension.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "checks.hpp"
#include "line_fit.hpp"

namespace papilla {
namespace {

using texture_detail::pixel_index;

constexpr int k_least_side = 32;  // Three dyadic scales from 8 on.
constexpr std::array<int, 4> k_box_scales = {8, 16, 32, 64};
constexpr std::array<int, 6> k_share_scales = {4, 6, 8, 12, 16, 24};

struct Bytes {
  std::vector<std::uint8_t> values;
  int width = 0, height = 0;
};

/// Calls visit(number of points) for every occupied box of side s.
void visit_boxes(const Bytes& picture, int s, const std::function<void(int)>& visit) {
  const int columns = picture.width / s, rows = picture.height / s;
  const int left = (picture.width - columns * s) / 2, top = (picture.height - rows * s) / 2;
  std::vector<int> counts(static_cast<std::size_t>(255 / s + 1));
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      counts.assign(counts.size(), 0);
      for (int y = top + row * s; y < top + (row + 1) * s; ++y)
        for (int x = left + column * s; x < left + (column + 1) * s; ++x)
          ++counts[picture.values[pixel_index(x, y, picture.width)] / static_cast<unsigned>(s)];
      for (const int count : counts)
        if (count > 0) visit(count);
    }
}

/// Sums contribution(share of the counted points) over the boxes; `finish` turns the sum into N.
FractalEstimate estimate(const GreyImage& image, std::span<const int> scales, const char* function,
                         double (*contribution)(double share), double (*finish)(double sum)) {
  texture_detail::require_image(image, function, k_least_side);
  const Bytes picture{texture_detail::stretched_bytes(image), image.width, image.height};
  const double area = static_cast<double>(image.width) * image.height;
  std::vector<ScalePoint> curve;
  for (const int s : scales) {
    if (s > std::min(image.width, image.height)) continue;
    const double counted = static_cast<double>(image.width / s * s) * (image.height / s * s);
    double sum = 0;
    visit_boxes(picture, s, [&](int points) { sum += contribution(points / counted); });
    curve.push_back({static_cast<double>(s), finish(sum) * area / counted});
  }
  return texture_detail::estimate_from_log_log(std::move(curve));
}

}  // namespace

FractalEstimate box_dimension(const GreyImage& image) {
  return estimate(
      image, k_box_scales, "box_dimension", [](double) { return 1.0; }, [](double sum) { return sum; });
}

FractalEstimate information_dimension(const GreyImage& image) {
  return estimate(
      image, k_share_scales, "information_dimension", [](double p) { return -p * std::log(p); },
      [](double entropy) { return std::exp(entropy); });
}

FractalEstimate correlation_dimension(const GreyImage& image) {
  return estimate(
      image, k_share_scales, "correlation_dimension", [](double p) { return p * p; },
      [](double sum) { return 1 / sum; });
}

}  // namespace papilla
