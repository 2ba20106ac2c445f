// SPDX-License-Identifier: MIT
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <mutex>

#include "codecs.hpp"

namespace papilla::io_detail {
namespace {

using OIIO::ImageInput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

StoredPicture described(const ImageInput& input) {
  const ImageSpec& spec = input.spec();
  StoredPicture stored;
  stored.width = spec.width;
  stored.height = spec.height;
  stored.depth = spec.depth;
  stored.channels = spec.nchannels;
  stored.tile_width = spec.tile_width;
  stored.tile_height = spec.tile_height;
  stored.sample_bytes = static_cast<int>(spec.format.basesize());
  stored.is_float = spec.format.is_floating_point();
  stored.is_deep = spec.deep;
  stored.format = input.format_name();
  stored.photometric = spec.get_int_attribute("tiff:PhotometricInterpretation");
  stored.x_resolution = spec.get_float_attribute("XResolution");
  stored.y_resolution = spec.get_float_attribute("YResolution", stored.x_resolution);
  stored.resolution_unit = spec.get_string_attribute("ResolutionUnit");
  const OIIO::ParamValue* profile = spec.find_attribute("ICCProfile");
  if (profile && profile->type().basetype == TypeDesc::UINT8) {
    const auto* bytes = static_cast<const std::byte*>(profile->data());
    stored.profile.assign(bytes, bytes + profile->type().size());
  }
  return stored;
}

class Decoder final : public PictureDecoder {
 public:
  Decoder(std::unique_ptr<OIIO::Filesystem::IOMemReader> memory, std::unique_ptr<ImageInput> input)
      : memory_(std::move(memory)), input_(std::move(input)), stored_(described(*input_)) {}

  const StoredPicture& stored() const noexcept override { return stored_; }

  bool read(int top, int rows, int channels, SampleType type, void* values) override {
    const ImageSpec& s = input_->spec();
    const TypeDesc format = type == SampleType::byte   ? TypeDesc::UINT8
                            : type == SampleType::word ? TypeDesc::UINT16
                                                       : TypeDesc::FLOAT;
    const int y = s.y + top;
    const bool done = s.tile_height > 0 ? input_->read_tiles(0, 0, s.x, s.x + s.width, y, y + rows, s.z, s.z + 1, 0,
                                                             channels, format, values)
                                        : input_->read_scanlines(0, 0, y, y + rows, s.z, 0, channels, format, values);
    return done && !input_->has_error();
  }

  std::string error() override { return input_->geterror(); }

 private:
  std::unique_ptr<OIIO::Filesystem::IOMemReader> memory_;
  std::unique_ptr<ImageInput> input_;
  StoredPicture stored_;
};

}  // namespace

std::unique_ptr<PictureDecoder> open_decoder(std::string_view format, const std::string& name,
                                             std::optional<std::span<const std::byte>> bytes, int most_megabytes,
                                             std::string& reason) {
  static std::mutex mutex;  // The limit is one for the process.
  const std::scoped_lock lock(mutex);
  OIIO::attribute("limits:imagesize_MB", most_megabytes);
  OIIO::attribute("tiff:multithread", 0);  // With threads a tile that can't be decompressed is black, and no error.
  ImageSpec spec, wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);  // Values as they are stored, not multiplied by alpha.
  std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;
  if (bytes)
    memory = std::make_unique<OIIO::Filesystem::IOMemReader>(const_cast<std::byte*>(bytes->data()), bytes->size());
  auto input = ImageInput::create(std::string(format));
  if (input && (!memory || input->set_ioproxy(memory.get())) && input->open(name, spec, wishes))
    return std::make_unique<Decoder>(std::move(memory), std::move(input));
  reason = input ? input->geterror() : OIIO::geterror();
  return nullptr;
}

}  // namespace papilla::io_detail
