// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "picture_codec.hpp"

namespace papilla::io_detail {

std::size_t pixel_count(int width, int height);

/// A flat picture whose file is open and whose size is known; nothing of it is decoded yet.
class PictureInput {
 public:
  /// @throws IoError, InvalidInput as read_grey_image().
  PictureInput(const std::filesystem::path& path, std::size_t most_pixels);
  /// A picture in memory, PNG or JPEG, which must outlive it; `name` only names it in messages.
  PictureInput(std::span<const std::byte> bytes, const std::string& name, std::size_t most_pixels);

  int width() const noexcept { return stored().width; }
  int height() const noexcept { return stored().height; }
  int channels() const noexcept { return stored().channels >= 3 ? 3 : 1; }  ///< Colours, or the first channel as grey.
  int stored_channels() const noexcept { return stored().channels; }
  bool is_float() const noexcept { return stored().is_float; }
  int bits() const noexcept { return 8 * stored().sample_bytes; }
  std::vector<float> curve() const;  ///< As in GreyImage.
  double pitch_mm() const noexcept;  ///< From the file's resolution; 0 when it has none or pixels are not square.
  int tile_rows() const noexcept { return stored().tile_height; }  ///< 0: the picture is not tiled.
  const std::string& name() const noexcept { return name_; }

  /// @throws InvalidInput when `bytes` and what the reader of the format holds are more than picture_memory().
  void require_memory(std::uint64_t bytes) const;

  /// Decodes `rows` rows from `top` on: the first channels() channels of every pixel, interleaved, as floats or bytes.
  /// Of a tiled picture `top` and `rows` are whole tiles, but for the last rows.
  /// @throws InvalidInput naming the file and the row when it is damaged there.
  void read(int top, int rows, float* values);
  void read(int top, int rows, unsigned char* values);
  /// The same of the first `channels` channels. @pre 0 < channels <= stored_channels().
  void read_channels(int top, int rows, int channels, float* values);
  void read_channels(int top, int rows, int channels, unsigned char* values);

 private:
  const StoredPicture& stored() const noexcept { return decoder_->stored(); }
  void check_size(std::uintmax_t bytes, std::size_t most_pixels) const;
  void read(int top, int rows, int channels, SampleType type, std::size_t sample_bytes, void* values);

  std::string name_;
  std::unique_ptr<PictureDecoder> decoder_;
  std::uint64_t held_bytes_ = 0;
};

}  // namespace papilla::io_detail
