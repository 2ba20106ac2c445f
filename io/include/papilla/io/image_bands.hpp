// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "papilla/texture/image.hpp"

namespace papilla {

/// Pictures of more pixels than this are refused even when they are read band by band. JPEG files and interlaced PNG
/// files, which their readers hold as a whole, are refused from k_max_image_pixels on.
inline constexpr std::size_t k_max_streamed_pixels = std::size_t{65536} * 65536;

/// Reads a picture from top to bottom, some rows at a time, with the values of read_grey_image().
/// Memory: the rows asked for, and 64 rows (or those of one tile of a tiled file) as the file stores them.
class ImageBands {
 public:
  /// Opens the file and looks at its size.
  /// @throws IoError, InvalidInput as read_grey_image(); InvalidInput too when the picture is over `most_pixels`.
  /// @param sample_side the longer side of sample(): every n-th pixel of every n-th row, n the least that gives it.
  explicit ImageBands(const std::filesystem::path& path, std::size_t most_pixels = k_max_streamed_pixels,
                      int sample_side = 1024);
  ~ImageBands();
  ImageBands(const ImageBands&) = delete;
  ImageBands& operator=(const ImageBands&) = delete;

  int width() const noexcept;
  int height() const noexcept;
  int bits() const noexcept;         ///< As in GreyImage.
  double pitch_mm() const noexcept;  ///< As in GreyImage.

  /// The next `rows` rows, fewer at the end of the picture, none after it.
  /// @throws InvalidInput naming the file when it is damaged there or holds a number that is not finite.
  GreyImage next(int rows);

  /// Every k-th pixel of every k-th row read so far, in colour, k such that the whole picture gives at most 1024 a
  /// side.
  const ColorImage& sample() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace papilla
