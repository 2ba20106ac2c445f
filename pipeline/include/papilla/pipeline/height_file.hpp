// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "papilla/texture/height_map.hpp"

namespace papilla {

/// Writes a relief in the format of the extension: 16-bit grey .png (lowest height black, highest white), or
/// 32-bit float .exr, .tif, .tiff in millimetres.
/// @throws InvalidInput for other extensions; IoError when writing fails.
void write_height_file(const std::filesystem::path& path, const HeightMap& map);

}  // namespace papilla
