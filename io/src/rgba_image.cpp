// SPDX-License-Identifier: MIT
#include "papilla/io/rgba_image.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "papilla/core/error.hpp"
#include "papilla/core/srgb.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/io/scene.hpp"
#include "picture_input.hpp"
#include "png_stream.hpp"

namespace papilla {
namespace {

using io_detail::PictureInput;
using io_detail::pixel_count;

/// All rows of the first `channels` channels.
template <class T>
Values<T> read_rows(PictureInput& input, int channels) {
  const std::size_t row_values = pixel_count(input.width(), channels);
  Values<T> values(row_values * static_cast<std::size_t>(input.height()));
  const int step = input.tile_rows() > 0 ? input.tile_rows() : input.height();
  for (int row = 0; row < input.height(); row += step)
    input.read_channels(row, std::min(step, input.height() - row), channels,
                        values.data() + row_values * static_cast<std::size_t>(row));
  return values;
}

RgbaImage read_rgba(PictureInput& input) {
  const int channels = std::min(input.stored_channels(), 4);
  const std::size_t pixels = pixel_count(input.width(), input.height());
  input.require_memory((4 + static_cast<std::size_t>(channels)) * pixels);
  const Values<unsigned char> stored = read_rows<unsigned char>(input, channels);
  RgbaImage image{input.width(), input.height(), Values<unsigned char>(4 * pixels)};
  const bool is_grey = channels < 3, with_alpha = channels == 2 || channels == 4;
  const auto n = static_cast<std::size_t>(channels);
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t c = 0; c < 3; ++c) image.pixels[4 * i + c] = stored[n * i + (is_grey ? 0 : c)];
    image.pixels[4 * i + 3] = with_alpha ? stored[n * i + n - 1] : 255;
  }
  return image;
}

RgbaImage opaque(const ColorImage& color) {
  RgbaImage image{color.width, color.height, Values<unsigned char>(color.pixels.size() / 3 * 4, 255)};
  for (std::size_t i = 0; i < color.pixels.size(); ++i) image.pixels[4 * (i / 3) + i % 3] = color.pixels[i];
  return image;
}

}  // namespace

bool has_alpha(const RgbaImage& image) noexcept {
  for (std::size_t i = 3; i < image.pixels.size(); i += 4)
    if (image.pixels[i] != 255) return true;
  return false;
}

RgbaImage read_rgba_image(const std::filesystem::path& path) {
  PictureInput input(path, k_max_image_pixels);
  return input.is_float() ? opaque(read_color_image(path)) : read_rgba(input);
}

RgbaImage decode_rgba_image(std::span<const std::byte> bytes, const std::string& name) {
  PictureInput input(bytes, name, k_max_image_pixels);
  return read_rgba(input);
}

RgbaImage decode_rgba_image(const Scene& scene, std::size_t image) {
  return decode_rgba_image(scene.images[image].bytes, picture_name(scene, image));
}

std::vector<std::byte> encode_png(const RgbaImage& image) {
  if (image.width < 1 || image.height < 1 || image.pixels.size() != 4 * pixel_count(image.width, image.height))
    throw InvalidInput(fmt::format("encode_png: {} values for an RGBA picture of {} x {}", image.pixels.size(),
                                   image.width, image.height));
  return io_detail::png_stream({image.width, image.height, 4, 8, image.pixels.data()});
}

LinearImage read_linear_image(const std::filesystem::path& path) {
  PictureInput input(path, k_max_image_pixels);
  const int channels = input.channels();
  const std::size_t pixels = pixel_count(input.width(), input.height());
  input.require_memory(sizeof(float) * (3 + static_cast<std::size_t>(channels)) * pixels);
  const Values<float> stored = read_rows<float>(input, channels);
  LinearImage image{input.width(), input.height(), Values<float>(3 * pixels)};
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const float value = stored[channels == 3 ? i : i / 3];
    if (!std::isfinite(value))
      throw InvalidInput(fmt::format("{}: pixel ({}, {}) is not finite", path.string(),
                                     i / 3 % static_cast<std::size_t>(image.width),
                                     i / 3 / static_cast<std::size_t>(image.width)));
    image.pixels[i] =
        input.is_float() ? std::max(value, 0.0F) : static_cast<float>(linear_from_srgb(static_cast<double>(value)));
  }
  return image;
}

}  // namespace papilla
