// SPDX-License-Identifier: MIT
#include "papilla/texture/crop.hpp"

#include <algorithm>
#include <string>

#include "papilla/core/error.hpp"

namespace papilla {

GreyImage crop(const GreyImage& image, int left, int top, int width, int height) {
  if (left < 0 || top < 0 || width < 1 || height < 1 || width > image.width - left || height > image.height - top)
    throw InvalidInput("crop: " + std::to_string(width) + " x " + std::to_string(height) + " pixels from (" +
                       std::to_string(left) + ", " + std::to_string(top) + ") are not within the picture's " +
                       std::to_string(image.width) + " x " + std::to_string(image.height));
  GreyImage part{width, height, {}, image.pitch_mm, image.bits};
  part.pixels.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = top; y < top + height; ++y) {
    const auto first = image.pixels.begin() + static_cast<std::ptrdiff_t>(image.index(left, y));
    part.pixels.insert(part.pixels.end(), first, first + width);
  }
  return part;
}

GreyImage middle_part(const GreyImage& image, int most_side) {
  const int width = std::min(image.width, most_side), height = std::min(image.height, most_side);
  return crop(image, (image.width - width) / 2, (image.height - height) / 2, width, height);
}

}  // namespace papilla
