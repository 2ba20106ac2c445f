// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace papilla {

/// A decoded height picture, row by row from the top left.
struct Grey16 {
  int width = 0, height = 0;
  int bits = 0;  ///< Bits per sample of the file: 1, 2, 4, 8 or 16.
  std::vector<std::uint16_t> values;
};

/// A decoded colour picture, row by row from the top left.
struct Rgb16 {
  int width = 0, height = 0;
  int bits = 0;  ///< As of Grey16.
  std::vector<std::array<std::uint16_t, 3>> values;
};

/// The first channel of a PNG as stored, without any gamma or colour conversion. Samples of 8 bits and fewer are
/// widened to the full range (8 bits: times 257). At most 2^26 pixels (8192 x 8192).
/// Cost: linear; 16 bytes per pixel while decoding.
/// @param name  what messages call the picture.
/// @throws InvalidInput when the bytes are no PNG, damaged, or the picture is too large.
Grey16 decode_grey16(std::span<const std::byte> bytes, const std::string& name);

/// Red, green and blue in the same way; a grey picture has three times the same.
Rgb16 decode_rgb16(std::span<const std::byte> bytes, const std::string& name);

}  // namespace papilla
