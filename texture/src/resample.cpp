// SPDX-License-Identifier: GPL-3.0-or-later
#include "papilla/texture/resample.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

#include "checks.hpp"
#include "fft.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using texture_detail::RealFft2d;

/// The relief and its mirror images in a periodic relief of twice the size.
HeightMap reflected(const HeightMap& relief) {
  HeightMap twice{2 * relief.width, 2 * relief.height, {}, relief.pitch_mm_x, relief.pitch_mm_y, true};
  for (int y = 0; y < twice.height; ++y)
    for (int x = 0; x < twice.width; ++x)
      twice.mm.push_back(relief.at(std::min(x, twice.width - 1 - x), std::min(y, twice.height - 1 - y)));
  return twice;
}

/// Signed frequency of row v of a transform of n rows.
int signed_frequency(int v, int n) { return v <= n / 2 ? v : v - n; }

HeightMap resample_periodic(const HeightMap& relief, int width, int height) {
  RealFft2d source(relief.width, relief.height), target(width, height);
  for (int y = 0; y < relief.height; ++y)
    for (int x = 0; x < relief.width; ++x) source.real(x, y) = static_cast<double>(relief.at(x, y));
  source.forward();
  std::fill_n(target.spectrum(), target.spectrum_width() * static_cast<std::size_t>(height), std::complex<double>());

  // Sample i lies at (i + ½)/n of the side: the new first sample is this far from the old one.
  const double shift_x = 0.5 / width - 0.5 / relief.width, shift_y = 0.5 / height - 0.5 / relief.height;
  const double norm = 1 / (static_cast<double>(relief.width) * relief.height);
  const int kept_x = std::min(width, relief.width), kept_y = std::min(height, relief.height);
  for (int v = 0; v < height; ++v) {
    const int frequency_y = signed_frequency(v, height);
    if (2 * std::abs(frequency_y) >= kept_y && frequency_y != 0) continue;
    const int from = frequency_y < 0 ? frequency_y + relief.height : frequency_y;
    for (int u = 0; u == 0 || 2 * u < kept_x; ++u) {
      const double angle = 2 * std::numbers::pi * (u * shift_x + frequency_y * shift_y);
      target.spectrum()[static_cast<std::size_t>(v) * target.spectrum_width() + static_cast<std::size_t>(u)] =
          norm * std::polar(1.0, angle) *
          source.spectrum()[static_cast<std::size_t>(from) * source.spectrum_width() + static_cast<std::size_t>(u)];
    }
  }
  target.backward();
  HeightMap result{
      width,          height, {}, relief.pitch_mm_x * relief.width / width, relief.pitch_mm_y * relief.height / height,
      relief.periodic};
  result.mm.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) result.mm.push_back(static_cast<float>(target.real(x, y)));
  return result;
}

/// The top left quarter of a relief made by reflected(), after resampling.
HeightMap quarter(const HeightMap& twice) {
  HeightMap result{twice.width / 2, twice.height / 2, {}, twice.pitch_mm_x, twice.pitch_mm_y, false};
  for (int y = 0; y < result.height; ++y)
    for (int x = 0; x < result.width; ++x) result.mm.push_back(twice.at(x, y));
  return result;
}

}  // namespace

HeightMap resample(const HeightMap& relief, int width, int height) {
  texture_detail::require_height_map(relief, "resample", false);
  constexpr int k_most = 16384;
  if (width < 1 || height < 1 || width > k_most || height > k_most)
    throw InvalidInput("resample: size " + std::to_string(width) + " x " + std::to_string(height) +
                       " is not within 1 to " + std::to_string(k_most));
  if (width == relief.width && height == relief.height) return relief;
  if (relief.periodic) return resample_periodic(relief, width, height);
  return quarter(resample_periodic(reflected(relief), 2 * width, 2 * height));
}

GreyImage crop(const GreyImage& image, int left, int top, int width, int height) {
  if (left < 0 || top < 0 || width < 1 || height < 1 || width > image.width - left || height > image.height - top)
    throw InvalidInput("crop: " + std::to_string(width) + " x " + std::to_string(height) + " pixels from (" +
                       std::to_string(left) + ", " + std::to_string(top) + ") are not within the picture's " +
                       std::to_string(image.width) + " x " + std::to_string(image.height));
  GreyImage part{width, height, {}, image.pitch_mm, image.bits, image.curve};
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
