// SPDX-License-Identifier: MIT
#include "glb_document.hpp"
#include "papilla/io/rgba_image.hpp"
#include "picture_codec.hpp"

namespace papilla {
namespace {

/// Without alpha where all is opaque: interleaved samples of three or four channels.
Values<unsigned char> samples_of(const RgbaImage& image, int channels) {
  if (channels == 4) return image.pixels;
  Values<unsigned char> samples;
  samples.reserve(image.pixels.size() / 4 * 3);
  for (std::size_t i = 0; i < image.pixels.size(); i += 4)
    samples.insert(samples.end(), image.pixels.begin() + static_cast<std::ptrdiff_t>(i),
                   image.pixels.begin() + static_cast<std::ptrdiff_t>(i + 3));
  return samples;
}

}  // namespace

std::optional<EncodedImage> recoded_picture(const EncodedImage& image, PictureCoding coding, int quality,
                                            const std::string& name) {
  const bool is_webp = coding == PictureCoding::webp;
  const std::string type = is_webp ? "image/webp" : "image/jpeg";
  const bool is_read = image.mime_type == "image/png" || image.mime_type == "image/jpeg";
  if (coding == PictureCoding::as_is || !is_read || image.mime_type == type) return std::nullopt;
  const RgbaImage decoded = decode_rgba_image(image.bytes, name);
  const int channels = has_alpha(decoded) ? 4 : 3;
  if (channels == 4 && !is_webp) return std::nullopt;
  const Values<unsigned char> samples = samples_of(decoded, channels);
  const io_detail::PictureToStore picture{
      .width = decoded.width, .height = decoded.height, .channels = channels, .quality = quality};
  const std::vector<unsigned char> made = io_detail::pictures_plugin()
                                              .encoder(is_webp ? "picture.webp" : "picture.jpg", picture)
                                              ->encode(io_detail::SampleType::byte, samples.data());
  if (made.size() >= image.bytes.size()) return std::nullopt;
  const auto bytes = std::as_bytes(std::span(made));
  EncodedImage result{.name = image.name,
                      .mime_type = type,
                      .uri = {},
                      .bytes = {bytes.begin(), bytes.end()},
                      .extras_json = image.extras_json};
  return result;
}

}  // namespace papilla
