// SPDX-License-Identifier: MIT
#include "papilla/io/image_file.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/units.hpp"
#include "papilla/io/image_bands.hpp"
#include "picture_input.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;
using io_detail::check_png;
using io_detail::check_size;
using io_detail::color_channels;
using io_detail::open_picture;
using io_detail::pixel_count;
using io_detail::stored_values;
using OIIO::ImageInput;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

/// The first `channels` channels of every pixel, interleaved.
template <class T>
std::vector<T> read_pixels(ImageInput& input, const fs::path& path, int channels) {
  const ImageSpec& spec = input.spec();
  std::vector<T> pixels(pixel_count(spec.width, spec.height) * static_cast<std::size_t>(channels));
  if (!input.read_image(0, 0, 0, channels, OIIO::BaseTypeFromC<T>::value, pixels.data()))
    throw InvalidInput(path.string() + ": is damaged: " + first_line(input.geterror()));
  return pixels;
}

ColorImage read_rgb(ImageInput& input, const fs::path& path) {
  const ImageSpec& spec = input.spec();
  const int channels = color_channels(spec);
  ColorImage image{spec.width, spec.height, read_pixels<unsigned char>(input, path, channels)};
  if (channels == 3) return image;
  std::vector<unsigned char> rgb(3 * image.pixels.size());
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = image.pixels[i / 3];
  image.pixels = std::move(rgb);
  return image;
}

/// Whether the format can store the type. Checked first, because libpng prints to stderr about a file that is opened
/// and not written.
bool can_hold(const ImageOutput& output, TypeDesc type) {
  const std::string_view format = output.format_name();
  if (format == "png") return type != TypeDesc::FLOAT;
  if (format == "jpeg") return type == TypeDesc::UINT8;
  return format != "openexr" || type == TypeDesc::FLOAT;
}

/// The file's bytes; `path` only names it and chooses the format.
std::vector<unsigned char> encode(const fs::path& path, const ImageSpec& spec, TypeDesc source, const void* pixels) {
  const auto output = ImageOutput::create(path.string());
  if (!output || !output->supports("ioproxy")) {
    OIIO::geterror();
    throw InvalidInput(path.string() + ": pictures can be written as .png, .tif, .exr and .jpg");
  }
  if (!can_hold(*output, spec.format))
    throw InvalidInput(fmt::format("{}: the format cannot hold {}", path.string(), spec.format.c_str()));
  OIIO::Filesystem::IOVecOutput memory;
  if (!output->set_ioproxy(&memory) || !output->open(path.string(), spec))
    throw InvalidInput(path.string() + ": " + first_line(output->geterror()));
  if (!output->write_image(source, pixels) || !output->close())
    throw IoError(path.string() + ": " + first_line(output->geterror()));
  return memory.buffer();
}

void write_bytes(const fs::path& path, const std::vector<unsigned char>& data) {
  write_atomically(path, {reinterpret_cast<const char*>(data.data()), data.size()});
}

void set_pitch(ImageSpec& spec, double pitch_mm_x, double pitch_mm_y) {
  if (!(pitch_mm_x > 0) || !(pitch_mm_y > 0)) return;
  spec.attribute("ResolutionUnit", "in");  // OpenEXR knows no other unit.
  spec.attribute("XResolution", static_cast<float>(k_mm_per_inch / pitch_mm_x));
  spec.attribute("YResolution", static_cast<float>(k_mm_per_inch / pitch_mm_y));
  spec.attribute("PixelAspectRatio", static_cast<float>(pitch_mm_x / pitch_mm_y));
}

void check_pixels(int width, int height, std::size_t values, std::size_t channels, const char* function) {
  if (width < 1 || height < 1 || values != channels * pixel_count(width, height))
    throw InvalidInput(fmt::format("{}: {} values for a picture of {} x {}", function, values, width, height));
}

std::vector<std::byte> to_bytes(const std::vector<unsigned char>& data) {
  const auto bytes = std::as_bytes(std::span(data));
  return {bytes.begin(), bytes.end()};
}

}  // namespace

GreyImage read_grey_image(const fs::path& path) {
  ImageBands bands(path, k_max_image_pixels);
  return bands.next(bands.height());
}

ColorImage read_color_image(const fs::path& path) { return read_rgb(*open_picture(path, k_max_image_pixels), path); }

Picture read_picture(const fs::path& path) {
  ImageBands bands(path, k_max_image_pixels, std::numeric_limits<int>::max());
  GreyImage grey = bands.next(bands.height());
  return {std::move(grey), bands.sample()};
}

ColorImage decode_color_image(std::span<const std::byte> bytes, const std::string& name) {
  check_png(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()), name);
  OIIO::Filesystem::IOMemReader memory(const_cast<std::byte*>(bytes.data()), bytes.size());
  const bool jpeg = bytes.size() > 2 && bytes[0] == std::byte{0xff} && bytes[1] == std::byte{0xd8};
  const auto input = ImageInput::create(jpeg ? "jpeg" : "png");
  ImageSpec spec;
  if (!input || !input->set_ioproxy(&memory) || !input->open(name, spec, stored_values()))
    throw InvalidInput(name + ": is no picture: " + first_line(input ? input->geterror() : OIIO::geterror()));
  check_size(input->spec(), name, bytes.size(), k_max_image_pixels);
  return read_rgb(*input, name);
}

std::vector<std::byte> encode_png(const ColorImage& image) {
  check_pixels(image.width, image.height, image.pixels.size(), 3, "encode_png");
  const ImageSpec spec(image.width, image.height, 3, TypeDesc::UINT8);
  return to_bytes(encode("picture.png", spec, TypeDesc::UINT8, image.pixels.data()));
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
  const ImageSpec spec(map.width, map.height, 1, TypeDesc::UINT16);
  result.png = to_bytes(encode("height.png", spec, TypeDesc::UINT16, samples.data()));
  return result;
}

void write_grey_image(const fs::path& path, const GreyImage& image, int bits) {
  check_pixels(image.width, image.height, image.pixels.size(), 1, "write_grey_image");
  if (bits != 8 && bits != 16 && bits != 32)
    throw InvalidInput(fmt::format("write_grey_image: bits = {} is not 8, 16 or 32", bits));
  const TypeDesc type = bits == 8 ? TypeDesc::UINT8 : bits == 16 ? TypeDesc::UINT16 : TypeDesc::FLOAT;
  ImageSpec spec(image.width, image.height, 1, type);
  set_pitch(spec, image.pitch_mm, image.pitch_mm);
  write_bytes(path, encode(path, spec, TypeDesc::FLOAT, image.pixels.data()));
}

void write_height_float(const fs::path& path, const HeightMap& map) {
  check_pixels(map.width, map.height, map.mm.size(), 1, "write_height_float");
  ImageSpec spec(map.width, map.height, 1, TypeDesc::FLOAT);
  set_pitch(spec, map.pitch_mm_x, map.pitch_mm_y);
  write_bytes(path, encode(path, spec, TypeDesc::FLOAT, map.mm.data()));
}

void write_color_image(const fs::path& path, const ColorImage& image) {
  check_pixels(image.width, image.height, image.pixels.size(), 3, "write_color_image");
  const ImageSpec spec(image.width, image.height, 3, TypeDesc::UINT8);
  write_bytes(path, encode(path, spec, TypeDesc::UINT8, image.pixels.data()));
}

}  // namespace papilla
