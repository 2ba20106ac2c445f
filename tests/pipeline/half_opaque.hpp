// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "papilla/core/atomic_file.hpp"
#include "papilla/io/rgba_image.hpp"

namespace papilla::test {

/// A red PNG of 4 x 4 pixels, opaque on the left, transparent on the right.
inline void write_half_opaque(const std::filesystem::path& file) {
  RgbaImage image{4, 4, {}};
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x)
      image.pixels.insert(image.pixels.end(), {255, 0, 0, static_cast<unsigned char>(x < 2 ? 255 : 0)});
  const std::vector<std::byte> png = encode_png(image);
  write_atomically(file, {reinterpret_cast<const char*>(png.data()), png.size()});
}

}  // namespace papilla::test
