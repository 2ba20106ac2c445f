// SPDX-License-Identifier: MIT
#include "papilla/pipeline/height_file.hpp"

#include <string_view>

#include "papilla/core/atomic_file.hpp"
#include "papilla/io/image_file.hpp"

namespace papilla {

void write_height_file(const std::filesystem::path& path, const HeightMap& map) {
  if (path.extension() != ".png") {
    write_height_float(path, map);
    return;
  }
  const EncodedHeight encoded = encode_height_png16(map);
  write_atomically(path, std::string_view(reinterpret_cast<const char*>(encoded.png.data()), encoded.png.size()));
}

}  // namespace papilla
