// SPDX-License-Identifier: MIT
#include "papilla/io/rgba_image.hpp"

#include <fmt/core.h>

#include <span>

#include "papilla/core/error.hpp"
#include "papilla/io/image_file.hpp"
#include "picture_codec.hpp"
#include "picture_input.hpp"

namespace papilla {

RgbaImage decode_rgba_image(const Scene& scene, std::size_t number) {
  const EncodedImage& encoded = scene.images[number];
  const std::string& named = encoded.name.empty() ? encoded.uri : encoded.name;
  io_detail::PictureInput input(encoded.bytes, named.empty() ? fmt::format("picture {} of the scene", number) : named,
                                k_max_image_pixels);
  const auto channels = static_cast<std::size_t>(input.stored_channels());
  const std::size_t pixels = io_detail::pixel_count(input.width(), input.height());
  input.require_memory((4 + channels) * pixels);
  std::vector<unsigned char> stored(channels * pixels);
  input.read_stored(stored.data());
  RgbaImage image{input.width(), input.height(), std::vector<unsigned char>(4 * pixels, 255)};
  const bool is_grey = channels < 3, has_alpha = channels == 2 || channels == 4;
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t k = 0; k < 3; ++k) image.pixels[4 * i + k] = stored[channels * i + (is_grey ? 0 : k)];
    if (has_alpha) image.pixels[4 * i + 3] = stored[channels * (i + 1) - 1];
  }
  return image;
}

std::vector<std::byte> encode_png(const RgbaImage& image) {
  if (image.width < 1 || image.height < 1 ||
      image.pixels.size() != 4 * io_detail::pixel_count(image.width, image.height))
    throw InvalidInput(fmt::format("encode_png: {} values for a picture of {} x {} with alpha", image.pixels.size(),
                                   image.width, image.height));
  const io_detail::PictureToStore picture{image.width, image.height, 4};
  const std::vector<unsigned char> data = io_detail::pictures_plugin()
                                              .encoder("picture.png", picture)
                                              ->encode(io_detail::SampleType::byte, image.pixels.data());
  const auto bytes = std::as_bytes(std::span(data));
  return {bytes.begin(), bytes.end()};
}

}  // namespace papilla
