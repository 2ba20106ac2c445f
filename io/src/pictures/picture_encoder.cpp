// SPDX-License-Identifier: MIT
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <ostream>

#include "codecs.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/units.hpp"

namespace papilla::io_detail {
namespace {

using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

TypeDesc type_of(SampleType type) {
  switch (type) {
    case SampleType::byte: return TypeDesc::UINT8;
    case SampleType::word: return TypeDesc::UINT16;
    case SampleType::real: break;
  }
  return TypeDesc::FLOAT;
}

/// Whether the format can store the type. Checked first, because libpng prints to stderr about a file that is opened
/// and not written.
bool can_hold(const ImageOutput& output, SampleType type) {
  const std::string_view format = output.format_name();
  if (format == "png") return type != SampleType::real;
  if (format == "jpeg" || format == "webp") return type == SampleType::byte;
  return format != "openexr" || type == SampleType::real;
}

ImageSpec spec_of(const PictureToStore& picture, std::string_view format) {
  ImageSpec spec(picture.width, picture.height, picture.channels, type_of(picture.type));
  if (picture.pitch_mm_x > 0 && picture.pitch_mm_y > 0) {
    spec.attribute("ResolutionUnit", "in");  // OpenEXR knows no other unit.
    spec.attribute("XResolution", static_cast<float>(k_mm_per_inch / picture.pitch_mm_x));
    spec.attribute("YResolution", static_cast<float>(k_mm_per_inch / picture.pitch_mm_y));
    spec.attribute("PixelAspectRatio", static_cast<float>(picture.pitch_mm_x / picture.pitch_mm_y));
  }
  if (picture.channels == 4) spec.attribute("oiio:UnassociatedAlpha", 1);  // Colours are stored as they are given.
  if (format == "jpeg" || format == "webp")
    spec.attribute("Compression", fmt::format("{}:{}", format, picture.quality));
  if (!picture.profile.empty())
    spec.attribute("ICCProfile", TypeDesc(TypeDesc::UINT8, static_cast<int>(picture.profile.size())),
                   picture.profile.data());
  return spec;
}

/// Lets OpenImageIO write into a stream. What the stream throws is kept, because it must not pass through C libraries.
class StreamOutput final : public OIIO::Filesystem::IOProxy {
 public:
  StreamOutput(const std::string& name, std::ostream& out) : IOProxy(name, Write), out_(out) {}

  const char* proxytype() const override { return "stream"; }
  bool seek(int64_t offset) override {
    m_pos = offset;
    return true;
  }
  size_t write(const void* bytes, size_t count) override {
    if (failure_) return 0;
    try {
      if (m_pos != written_to_) out_.seekp(m_pos);
      out_.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(count));
    } catch (...) {
      failure_ = std::current_exception();
      return 0;
    }
    written_to_ = m_pos += static_cast<int64_t>(count);
    size_ = std::max(size_, m_pos);
    return count;
  }
  size_t size() const override { return static_cast<size_t>(size_); }

  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  std::ostream& out_;
  std::exception_ptr failure_;
  int64_t written_to_ = 0, size_ = 0;
};

class Encoder final : public PictureEncoder {
 public:
  Encoder(std::string name, std::unique_ptr<ImageOutput> output, ImageSpec spec)
      : name_(std::move(name)), output_(std::move(output)), spec_(std::move(spec)) {}

  std::vector<unsigned char> encode(SampleType source, const void* pixels) override {
    OIIO::Filesystem::IOVecOutput memory;  // Before the output, whose destructor may write into it.
    const auto output = std::move(output_);
    if (!output->set_ioproxy(&memory) || !output->open(name_, spec_))
      throw InvalidInput(name_ + ": " + first_line(output->geterror()));
    if (!output->write_image(type_of(source), pixels) || !output->close())
      throw IoError(name_ + ": " + first_line(output->geterror()));
    return memory.buffer();
  }

  void encode_rows(std::ostream& out, const RowSource& rows) override {
    StreamOutput stream(name_, out);  // Before the output, whose destructor may write into it.
    const auto output = std::move(output_);
    std::vector<std::byte> row(spec_.scanline_bytes(true));
    const auto require = [&](bool done) {
      stream.rethrow();
      if (!done) throw IoError(name_ + ": " + first_line(output->geterror()));
    };
    require(output->set_ioproxy(&stream) && output->open(name_, spec_));
    for (int y = 0; y < spec_.height; ++y) {
      rows(y, row.data());
      require(output->write_scanline(y, 0, spec_.format, row.data()));
    }
    require(output->close());
  }

 private:
  std::string name_;
  std::unique_ptr<ImageOutput> output_;
  ImageSpec spec_;
};

}  // namespace

std::unique_ptr<PictureEncoder> make_encoder(const std::string& name, const PictureToStore& picture) {
  auto output = ImageOutput::create(name);
  if (!output || !output->supports("ioproxy")) {
    OIIO::geterror();
    throw InvalidInput(name + ": pictures can be written as .png, .tif, .exr and .jpg");
  }
  if (!can_hold(*output, picture.type))
    throw InvalidInput(fmt::format("{}: the format cannot hold {}", name, type_of(picture.type).c_str()));
  ImageSpec spec = spec_of(picture, output->format_name());
  return std::make_unique<Encoder>(name, std::move(output), std::move(spec));
}

}  // namespace papilla::io_detail
