// SPDX-License-Identifier: MIT
#pragma once

#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace papilla::io_detail {

std::size_t pixel_count(int width, int height);

/// Colours are read as three channels, everything else as its first one.
int color_channels(const OIIO::ImageSpec& spec);

/// Asks for values as they are stored, not multiplied by alpha.
OIIO::ImageSpec stored_values();

/// Millimetres per pixel from the file's resolution; 0 when it has none or its pixels are not square.
double pitch_of(const OIIO::ImageSpec& spec);

/// Checks the chunks of a PNG before libpng reads it, because libpng prints messages of its own to stderr. Accepts all
/// other formats. @throws InvalidInput naming `path` when a chunk is damaged.
void check_png(std::string_view bytes, const std::filesystem::path& path);

/// @throws InvalidInput when the picture is not flat, larger than `most_pixels`, or larger than a file of that many
/// bytes can hold.
void check_size(const OIIO::ImageSpec& spec, const std::filesystem::path& path, std::uintmax_t bytes,
                std::size_t most_pixels);

/// @throws IoError, InvalidInput as read_grey_image().
std::unique_ptr<OIIO::ImageInput> open_picture(const std::filesystem::path& path, std::size_t most_pixels);

}  // namespace papilla::io_detail
