// SPDX-License-Identifier: MIT
#include "papilla/io/decode_grey16.hpp"

#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

constexpr std::uint64_t k_max_pixels = std::uint64_t{1} << 26;
constexpr std::size_t k_header_size = 8 + 8 + 13;  ///< Signature, chunk header, IHDR.

struct PngHeader {
  std::uint32_t width, height;
  int bits;
};

std::uint32_t big_endian(std::span<const std::byte> bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | std::to_integer<std::uint32_t>(bytes[at + i]);
  return value;
}

PngHeader read_header(std::span<const std::byte> bytes, const std::string& name) {
  static constexpr std::array<unsigned char, 8> k_signature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  if (bytes.size() < k_header_size || std::memcmp(bytes.data(), k_signature.data(), k_signature.size()) != 0)
    throw InvalidInput(name + ": is no PNG picture");
  const PngHeader header{big_endian(bytes, 16), big_endian(bytes, 20), std::to_integer<int>(bytes[24])};
  if (header.width == 0 || header.height == 0 || std::uint64_t{header.width} * header.height > k_max_pixels)
    throw InvalidInput(name + ": has " + std::to_string(header.width) + " x " + std::to_string(header.height) +
                       " pixels; between 1 and 2^26 are supported");
  return header;
}

/// A chunk that announces more than there is would be allocated before it is read. What follows the last is left alone.
void check_chunks(std::span<const std::byte> bytes, const std::string& name) {
  constexpr std::uint32_t k_last = 0x49454e44;  // IEND
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    const std::uint32_t length = big_endian(bytes, at);
    if (length > bytes.size() - at - 12) break;
    if (big_endian(bytes, at + 4) == k_last) return;
    at += 12 + std::size_t{length};
  }
  throw InvalidInput(name + ": is damaged");
}

/// The picture as stored; 16 bits a sample as they lie in memory, or 8.
tinygltf::Image decode(std::span<const std::byte> bytes, const std::string& name, int& bits) {
  bits = read_header(bytes, name).bits;
  check_chunks(bytes, name);
  tinygltf::Image image;
  std::string error, warning;
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  if (bytes.size() > 0x7fffffffU ||
      !tinygltf::LoadImageData(&image, 0, &error, &warning, 0, 0, data, static_cast<int>(bytes.size()), nullptr))
    throw InvalidInput(name + ": is damaged");
  return image;
}

std::size_t pixels_of(const tinygltf::Image& image) {
  return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

std::uint16_t sample(const tinygltf::Image& image, std::size_t pixel, std::size_t channel) {
  const std::size_t at = pixel * static_cast<std::size_t>(image.component) + channel;
  std::uint16_t value = 0;
  if (image.bits != 16) return static_cast<std::uint16_t>(image.image[at] * 257U);
  std::memcpy(&value, &image.image[2 * at], 2);
  return value;
}

}  // namespace

Grey16 decode_grey16(std::span<const std::byte> bytes, const std::string& name) {
  Grey16 grey;
  const tinygltf::Image image = decode(bytes, name, grey.bits);
  grey.width = image.width, grey.height = image.height;
  grey.values.resize(pixels_of(image));
  for (std::size_t i = 0; i < grey.values.size(); ++i) grey.values[i] = sample(image, i, 0);
  return grey;
}

Rgb16 decode_rgb16(std::span<const std::byte> bytes, const std::string& name) {
  Rgb16 rgb;
  const tinygltf::Image image = decode(bytes, name, rgb.bits);
  rgb.width = image.width, rgb.height = image.height;
  const bool has_colour = image.component >= 3;
  rgb.values.resize(pixels_of(image));
  for (std::size_t i = 0; i < rgb.values.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) rgb.values[i][c] = sample(image, i, has_colour ? c : 0);
  return rgb;
}

}  // namespace papilla
