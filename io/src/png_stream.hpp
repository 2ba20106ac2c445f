// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace papilla::io_detail {

/// Samples of a picture, row by row, the channels of a pixel side by side.
struct PngSamples {
  int width, height;
  int channels;  ///< 1 grey, 3 RGB, 4 RGBA.
  int bits;      ///< 8, or 16 in the machine's order of bytes.
  const void* samples;
};

/// A PNG file of the samples as they are, without a profile: what scenes hold. Needs libpng alone, where the plug-in of
/// pictures brings hundreds of libraries.
/// @throws SolverFailure when libpng fails, which it does for want of memory only.
std::vector<std::byte> png_stream(const PngSamples& picture);

}  // namespace papilla::io_detail
