// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>

#include "papilla/texture/image.hpp"

namespace papilla {

/// Writes pictures as an endless animated GIF, 256 colours a picture chosen for it, the last one held for as long as
/// six others. Browsers, viewers and video editors read it. Time and memory grow with the pixels of all pictures.
/// @param frames  at least one, all of the same size, at most 65535 a side. @param per_second  above 0, at most 50.
/// @throws InvalidInput when a precondition is broken or the extension is not .gif; IoError when writing fails.
void write_animation(const std::filesystem::path& path, std::span<const ColorImage> frames, double per_second);

}  // namespace papilla
