// SPDX-License-Identifier: MIT
#include "papilla/io/image_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/image_bands.hpp"
#include "papilla/io/picture_memory.hpp"
#include "papilla/io/scene.hpp"
#include "picture_codec.hpp"
#include "picture_input.hpp"
#include "png_stream.hpp"
#include "profile_curve.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;
using io_detail::PictureInput;
using io_detail::PictureToStore;
using io_detail::pixel_count;
using io_detail::SampleType;

ColorImage read_rgb(PictureInput& input, std::size_t bytes_per_pixel) {
  const auto channels = static_cast<std::size_t>(input.channels());
  const std::size_t pixels = pixel_count(input.width(), input.height());
  input.require_memory((bytes_per_pixel + (channels == 3 ? 0 : channels)) * pixels);
  ColorImage image{input.width(), input.height(), Values<unsigned char>(channels * pixels)};
  const int step = input.tile_rows() > 0 ? input.tile_rows() : image.height;
  for (int row = 0; row < image.height; row += step)
    input.read(row, std::min(step, image.height - row), image.pixels.data() + channels * pixel_count(image.width, row));
  if (channels == 3) return image;
  Values<unsigned char> rgb(3 * pixels);
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = image.pixels[i / 3];
  image.pixels = std::move(rgb);
  return image;
}

/// The file's bytes; `path` only names it and chooses the format.
std::vector<unsigned char> encode(const fs::path& path, const PictureToStore& picture, SampleType source,
                                  const void* pixels) {
  return io_detail::pictures_plugin().encoder(path.string(), picture)->encode(source, pixels);
}

/// Writes row by row what read(y, row) gives, values of type T.
template <class T, class Read>
void write_rows(const fs::path& path, const PictureToStore& picture, const Read& read) {
  const auto encoder = io_detail::pictures_plugin().encoder(path.string(), picture);
  write_atomically(path, [&](std::ostream& out) {
    encoder->encode_rows(out, [&](int y, void* row) { read(y, static_cast<T*>(row)); });
  });
}

void write_bytes(const fs::path& path, const std::vector<unsigned char>& data) {
  write_atomically(path, {reinterpret_cast<const char*>(data.data()), data.size()});
}

void check_pixels(int width, int height, std::size_t values, std::size_t channels, const char* function) {
  if (width < 1 || height < 1 || values != channels * pixel_count(width, height))
    throw InvalidInput(fmt::format("{}: {} values for a picture of {} x {}", function, values, width, height));
}

}  // namespace

GreyImage read_grey_image(const fs::path& path, std::size_t bytes_per_pixel) {
  ImageBands bands(path, k_max_image_pixels);
  bands.require_memory(bytes_per_pixel);
  return bands.next(bands.height());
}

ColorImage read_color_image(const fs::path& path, std::size_t bytes_per_pixel) {
  PictureInput input(path, k_max_image_pixels);
  return input.is_float() ? read_picture(path, bytes_per_pixel + sizeof(float)).color
                          : read_rgb(input, bytes_per_pixel);
}

Picture read_picture(const fs::path& path, std::size_t bytes_per_pixel) {
  ImageBands bands(path, k_max_image_pixels, std::numeric_limits<int>::max());
  bands.require_memory(bytes_per_pixel);
  GreyImage grey = bands.next(bands.height());
  return {std::move(grey), bands.sample(), bands.bits(), 1};
}

Picture read_reduced_picture(const fs::path& path, int most_side, std::size_t bytes_per_pixel) {
  ImageBands bands(path, k_max_streamed_pixels, most_side);
  const int n = (std::max(bands.width(), bands.height()) - 1) / most_side + 1;
  GreyImage grey{(bands.width() + n - 1) / n, (bands.height() + n - 1) / n, {},
                 n * bands.pitch_mm(),        n > 1 ? 32 : bands.bits(),    bands.curve()};
  bands.require_memory(bytes_per_pixel, pixel_count(grey.width, grey.height));
  for (int row = 0; row < grey.height; ++row) {
    const GreyImage band = bands.next(n);
    for (int column = 0; column < grey.width; ++column) {
      const int left = column * n, right = std::min(left + n, band.width);
      double sum = 0;
      for (int y = 0; y < band.height; ++y)
        for (int x = left; x < right; ++x) sum += static_cast<double>(band.at(x, y));
      grey.pixels.push_back(static_cast<float>(sum / ((right - left) * band.height)));
    }
  }
  return {std::move(grey), bands.sample(), bands.bits(), n};
}

Picture read_fitting_picture(const fs::path& path, std::size_t bytes_per_pixel) {
  ImageBands bands(path);
  const double width = bands.width(), height = bands.height();
  const double bytes = static_cast<double>(bytes_per_pixel) * width * height;
  const double n = std::ceil(std::sqrt(bytes / static_cast<double>(picture_memory())));
  if (n > 1) {
    // One less a side than would just fit: picture_memory() is also for what the reader holds.
    const int most_side = std::max(1, static_cast<int>(std::max(width, height) / n) - 1);
    Picture reduced = read_reduced_picture(path, most_side, bytes_per_pixel);
    reduced.color = {};
    return reduced;
  }
  bands.require_memory(bytes_per_pixel);
  return {bands.next(bands.height()), {}, bands.bits(), 1};
}

ColorImage decode_color_image(std::span<const std::byte> bytes, const std::string& name) {
  PictureInput input(bytes, name, k_max_image_pixels);
  return read_rgb(input, 3);
}

std::string picture_name(const Scene& scene, std::size_t image) {
  const EncodedImage& encoded = scene.images[image];
  const std::string& named = encoded.name.empty() ? encoded.uri : encoded.name;
  return named.empty() ? fmt::format("picture {} of the scene", image) : named;
}

ColorImage decode_image(const Scene& scene, std::size_t image) {
  return decode_color_image(scene.images[image].bytes, picture_name(scene, image));
}

std::vector<std::byte> encode_png(const ColorImage& image) {
  check_pixels(image.width, image.height, image.pixels.size(), 3, "encode_png");
  return io_detail::png_stream({image.width, image.height, 3, 8, image.pixels.data()});
}

EncodedHeight encode_height_png16(const HeightMap& map) {
  check_pixels(map.width, map.height, map.mm.size(), 1, "encode_height_png16");
  if (!std::all_of(map.mm.begin(), map.mm.end(), [](float h) { return std::isfinite(h); }))
    throw InvalidInput("encode_height_png16: a height is not finite");
  const auto [low, high] = std::minmax_element(map.mm.begin(), map.mm.end());
  EncodedHeight result;
  result.offset_mm = double{*low};
  result.scale_mm = double{*high} - double{*low};
  const double steps_per_mm = result.scale_mm > 0 ? 65535 / result.scale_mm : 0;
  std::vector<std::uint16_t> samples(map.mm.size());
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = static_cast<std::uint16_t>(std::lround((double{map.mm[i]} - result.offset_mm) * steps_per_mm));
  result.png = io_detail::png_stream({map.width, map.height, 1, 16, samples.data()});
  return result;
}

void write_grey_image(const fs::path& path, const GreyImage& image, int bits, int jpeg_quality) {
  check_pixels(image.width, image.height, image.pixels.size(), 1, "write_grey_image");
  if (bits != 8 && bits != 16 && bits != 32)
    throw InvalidInput(fmt::format("write_grey_image: bits = {} is not 8, 16 or 32", bits));
  const SampleType type = bits == 8 ? SampleType::byte : bits == 16 ? SampleType::word : SampleType::real;
  PictureToStore picture{image.width, image.height, 1, type, image.pitch_mm, image.pitch_mm};
  picture.quality = jpeg_quality;
  std::vector<std::byte> profile;
  if (image.curve.size() >= 2 && path.extension() != ".exr") profile = io_detail::profile_of_curve(image.curve);
  picture.profile = profile;
  write_bytes(path, encode(path, picture, SampleType::real, image.pixels.data()));
}

void write_height_float(const fs::path& path, const HeightMap& map) {
  check_pixels(map.width, map.height, map.mm.size(), 1, "write_height_float");
  const PictureToStore picture{map.width, map.height, 1, SampleType::real, map.pitch_mm_x, map.pitch_mm_y};
  write_bytes(path, encode(path, picture, SampleType::real, map.mm.data()));
}

void write_height_rows(const fs::path& path, const SampleRows& heights_mm, double depth_mm, double pitch_mm) {
  const int width = heights_mm.width();
  PictureToStore picture{width, heights_mm.height(), 1, SampleType::real};
  if (path.extension() != ".png") {
    picture.pitch_mm_x = picture.pitch_mm_y = pitch_mm;
    write_rows<float>(path, picture, [&](int y, float* row) { heights_mm.read(0, y, width, row); });
    return;
  }
  picture.type = SampleType::word;
  std::vector<float> heights(static_cast<std::size_t>(width));
  const double steps_per_mm = depth_mm > 0 ? 65535 / depth_mm : 0;
  write_rows<std::uint16_t>(path, picture, [&](int y, std::uint16_t* row) {
    heights_mm.read(0, y, width, heights.data());
    for (const float height : heights)
      *row++ = static_cast<std::uint16_t>(std::lround(std::clamp(double{height} * steps_per_mm, 0.0, 65535.0)));
  });
}

void write_color_image(const fs::path& path, const ColorImage& image) {
  check_pixels(image.width, image.height, image.pixels.size(), 3, "write_color_image");
  write_bytes(path, encode(path, {image.width, image.height, 3}, SampleType::byte, image.pixels.data()));
}

}  // namespace papilla
