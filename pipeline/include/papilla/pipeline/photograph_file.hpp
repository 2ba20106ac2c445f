// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "papilla/texture/photograph_model.hpp"

namespace papilla {

/// Options of photograph_of_relief_file().
struct PhotographFileOptions {
  PhotographOptions photograph;
  double pitch_mm = 0;     ///< Of the relief; 0 takes the file's resolution, or else 0.1.
  double height_mm = 0.3;  ///< Black to white of a relief in whole numbers; floats are millimetres.
  int jpeg_quality = 92;   ///< Of .jpg.
};

/// What photograph_of_relief_file() made.
struct PhotographFile {
  Photograph photograph;
  double pitch_mm = 0;
  double range_mm = 0;  ///< Highest less lowest point of the relief.
};

/// Reads a relief, takes its photograph() and writes that in the format of the extension, .jpg included; .exr takes
/// linear brightness that is not rounded.
/// @throws InvalidInput, IoError as read_grey_image(), photograph() and write_grey_image().
PhotographFile photograph_of_relief_file(const std::filesystem::path& relief, const std::filesystem::path& output,
                                         const PhotographFileOptions& options);

}  // namespace papilla
