// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include "papilla/texture/image.hpp"

namespace papilla {

/// Pictures of more pixels than this are refused even when they are read band by band.
inline constexpr std::size_t k_max_streamed_pixels = std::size_t{65536} * 65536;

/// Reads a picture from top to bottom, some rows at a time, with the values of read_grey_image().
/// Memory: the rows asked for, 64 rows (or those of one tile of a tiled file) as the file stores them, and the whole
/// picture where the reader of the format holds it: progressive JPEG, interlaced PNG, BMP, GIF, WebP, DPX, PSD, TGA.
class ImageBands {
 public:
  /// Opens the file and looks at its size.
  /// @throws IoError, InvalidInput as read_grey_image(); InvalidInput too when the picture is over `most_pixels`, or a
  ///         band and what the reader holds are over picture_memory().
  /// @param sample_side the longer side of sample(), at most: means over n × n pixels, n the least that gives it.
  explicit ImageBands(const std::filesystem::path& path, std::size_t most_pixels = k_max_streamed_pixels,
                      int sample_side = 1024);
  ~ImageBands();
  ImageBands(const ImageBands&) = delete;
  ImageBands& operator=(const ImageBands&) = delete;

  int width() const noexcept;
  int height() const noexcept;
  int bits() const noexcept;                         ///< As in GreyImage.
  double pitch_mm() const noexcept;                  ///< As in GreyImage.
  const std::vector<float>& curve() const noexcept;  ///< As in GreyImage.

  /// @throws InvalidInput with the size of the picture when it takes more than picture_memory() at so many bytes a
  /// pixel, or when that many of its pixels do.
  void require_memory(std::size_t bytes_per_pixel) const;
  void require_memory(std::size_t bytes_per_pixel, std::size_t pixels) const;

  /// The next `rows` rows, fewer at the end of the picture, none after it.
  /// @throws InvalidInput naming the file and row when it is damaged there; file, pixel and value when a float is not
  ///         finite or its magnitude is over a million.
  GreyImage next(int rows);

  /// The rows read so far, in colour, as means over n × n pixels; n as for sample_side.
  const ColorImage& sample() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace papilla
