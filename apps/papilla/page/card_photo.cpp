// SPDX-License-Identifier: GPL-3.0-or-later
#include "page/card_photo.hpp"

#include <algorithm>
#include <cstddef>

#include "papilla/core/base64.hpp"
#include "papilla/io/image_file.hpp"

namespace papilla::app {
namespace {

/// Longer side of a photograph on a card.
constexpr int k_photo_px = 256;

/// The picture with whole pixels averaged, so that its longer side is at most `side` pixels.
ColorImage shrink(const ColorImage& image, int side) {
  const int factor = (std::max(image.width, image.height) + side - 1) / side;
  if (factor <= 1) return image;
  ColorImage small;
  small.width = std::max(1, image.width / factor);
  small.height = std::max(1, image.height / factor);
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x)
      for (int c = 0; c < 3; ++c) {
        int sum = 0, count = 0;
        for (int j = y * factor; j < std::min((y + 1) * factor, image.height); ++j)
          for (int i = x * factor; i < std::min((x + 1) * factor, image.width); ++i, ++count)
            sum += image.pixels[3 * (static_cast<std::size_t>(j) * static_cast<std::size_t>(image.width) +
                                     static_cast<std::size_t>(i)) +
                                static_cast<std::size_t>(c)];
        small.pixels.push_back(static_cast<unsigned char>(sum / std::max(count, 1)));
      }
  return small;
}

}  // namespace

std::string card_photo(const ColorImage& photograph) {
  return encode_base64(encode_png(shrink(photograph, k_photo_px)));
}

}  // namespace papilla::app
