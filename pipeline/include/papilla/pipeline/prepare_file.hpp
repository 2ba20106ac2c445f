// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>

#include "papilla/texture/prepare.hpp"

namespace papilla {

/// Options of prepare_picture_file().
struct PrepareFileOptions {
  PrepareOptions prepare;
  std::optional<int> width_px;  ///< Scale the result to this width, in proportion; above 0.
  double pitch_mm = 0;          ///< Millimetres per pixel; 0: from the file's resolution.
};

/// Reads a picture, prepares it with prepare_picture(), scales it when asked to and writes it with 16 bits. Scaling is
/// the last of the steps, and `after` is measured on what is written.
/// @throws InvalidInput, IoError as read_grey_image(), prepare_picture() and write_grey_image().
PreparedPicture prepare_picture_file(const std::filesystem::path& picture, const std::filesystem::path& output,
                                     const PrepareFileOptions& options);

}  // namespace papilla
