// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/io/plugin.hpp"
#include "papilla/texture/image.hpp"

/// What papilla_pictures.so offers to the readers and writers of pictures: the library that decodes and encodes, seen
/// without its types. The checks of files and memory are those of its callers.
namespace papilla::io_detail {

/// A flat picture as its file describes it.
struct StoredPicture {
  int width = 0, height = 0, depth = 0, channels = 0;
  int tile_width = 0, tile_height = 0;  ///< 0: stored in rows.
  int sample_bytes = 1;
  bool is_float = false;
  bool is_deep = false;
  std::string format;   ///< As in PictureFormat::name.
  int photometric = 0;  ///< Of a TIFF, its tag.
  float x_resolution = 0, y_resolution = 0;
  std::string resolution_unit;     ///< "in", "cm", "m" or empty.
  std::vector<std::byte> profile;  ///< ICC; empty where it has none.
};

enum class SampleType { byte, word, real };  ///< 8 and 16 bits, 32-bit float.

/// An open file of which nothing is decoded yet.
class PictureDecoder {
 public:
  virtual ~PictureDecoder() = default;
  virtual const StoredPicture& stored() const noexcept = 0;
  /// Decodes the first `channels` channels of `rows` rows from `top` on, whole tiles of a tiled picture.
  /// @returns whether that went well; error() tells otherwise. @throws std::bad_alloc, std::length_error.
  virtual bool read(int top, int rows, int channels, SampleType type, void* values) = 0;
  virtual std::string error() = 0;
};

/// A picture that is to be written.
struct PictureToStore {
  int width = 0, height = 0, channels = 1;
  SampleType type = SampleType::byte;
  double pitch_mm_x = 0, pitch_mm_y = 0;    ///< 0: none is stored.
  std::span<const std::byte> profile = {};  ///< ICC; empty: none is stored.
  int quality = 98;                         ///< 1 to 100, of JPEG and WebP.
};

/// Gives row y of the picture, samples of PictureToStore::type.
using RowSource = std::function<void(int y, void* row)>;

class PictureEncoder {
 public:
  virtual ~PictureEncoder() = default;
  /// The file's bytes, from samples of type `source`. @throws InvalidInput, IoError naming the file.
  virtual std::vector<unsigned char> encode(SampleType source, const void* pixels) = 0;
  /// Encodes row by row into a stream. @throws what the stream and `rows` throw; IoError naming the file.
  virtual void encode_rows(std::ostream& out, const RowSource& rows) = 0;
};

struct PicturesPlugin {
  PluginHeader header;
  /// Opens a file, or `bytes` of which `name` is only the name. Null and the reason when the library can't.
  /// @param most_megabytes of readers that take memory for whole pictures; 0: any.
  /// @throws std::bad_alloc, std::length_error.
  std::unique_ptr<PictureDecoder> (*open)(std::string_view format, const std::string& name,
                                          std::optional<std::span<const std::byte>> bytes, int most_megabytes,
                                          std::string& reason);
  /// `name` chooses the format and names the file in messages. @throws InvalidInput when the format can't hold it.
  std::unique_ptr<PictureEncoder> (*encoder)(const std::string& name, const PictureToStore& picture);
  /// A GIF that goes on for ever; the last picture is shown `held` times more. @throws IoError naming `name`.
  std::vector<unsigned char> (*encode_animation)(const std::string& name, std::span<const ColorImage> frames,
                                                 double per_second, std::size_t held);
};

/// The plug-in, loaded with the first picture. @throws IoError as load_plugin().
const PicturesPlugin& pictures_plugin();

}  // namespace papilla::io_detail
