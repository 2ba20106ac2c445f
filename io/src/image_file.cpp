// SPDX-License-Identifier: MIT
#include "papilla/io/image_file.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <memory>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/units.hpp"
#include "papilla/io/image_bands.hpp"
#include "papilla/io/picture_memory.hpp"
#include "papilla/io/scene.hpp"
#include "picture_input.hpp"
#include "profile_curve.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;
using io_detail::PictureInput;
using io_detail::pixel_count;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

ColorImage read_rgb(PictureInput& input, std::size_t bytes_per_pixel) {
  const auto channels = static_cast<std::size_t>(input.channels());
  const std::size_t pixels = pixel_count(input.width(), input.height());
  input.require_memory((bytes_per_pixel + (channels == 3 ? 0 : channels)) * pixels);
  ColorImage image{input.width(), input.height(), std::vector<unsigned char>(channels * pixels)};
  const int step = input.tile_rows() > 0 ? input.tile_rows() : image.height;
  for (int row = 0; row < image.height; row += step)
    input.read(row, std::min(step, image.height - row), image.pixels.data() + channels * pixel_count(image.width, row));
  if (channels == 3) return image;
  std::vector<unsigned char> rgb(3 * pixels);
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = image.pixels[i / 3];
  image.pixels = std::move(rgb);
  return image;
}

/// Whether the format can store the type. Checked first, because libpng prints to stderr about a file that is opened
/// and not written.
bool can_hold(const ImageOutput& output, TypeDesc type) {
  const std::string_view format = output.format_name();
  if (format == "png") return type != TypeDesc::FLOAT;
  if (format == "jpeg") return type == TypeDesc::UINT8;
  return format != "openexr" || type == TypeDesc::FLOAT;
}

std::unique_ptr<ImageOutput> make_output(const fs::path& path, const ImageSpec& spec) {
  auto output = ImageOutput::create(path.string());
  if (!output || !output->supports("ioproxy")) {
    OIIO::geterror();
    throw InvalidInput(path.string() + ": pictures can be written as .png, .tif, .exr and .jpg");
  }
  if (!can_hold(*output, spec.format))
    throw InvalidInput(fmt::format("{}: the format cannot hold {}", path.string(), spec.format.c_str()));
  return output;
}

/// The file's bytes; `path` only names it and chooses the format.
std::vector<unsigned char> encode(const fs::path& path, const ImageSpec& spec, TypeDesc source, const void* pixels) {
  OIIO::Filesystem::IOVecOutput memory;  // Before the output, whose destructor may write into it.
  const auto output = make_output(path, spec);
  if (!output->set_ioproxy(&memory) || !output->open(path.string(), spec))
    throw InvalidInput(path.string() + ": " + first_line(output->geterror()));
  if (!output->write_image(source, pixels) || !output->close())
    throw IoError(path.string() + ": " + first_line(output->geterror()));
  return memory.buffer();
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

/// Writes row by row what read(y, row) gives, values of type T.
template <class T, class Read>
void write_rows(const fs::path& path, const ImageSpec& spec, const Read& read) {
  auto made = make_output(path, spec);
  write_atomically(path, [&](std::ostream& out) {
    StreamOutput stream(path.string(), out);  // Before the output, whose destructor may write into it.
    const auto output = std::move(made);
    std::vector<T> row(static_cast<std::size_t>(spec.width));
    const auto require = [&](bool done) {
      stream.rethrow();
      if (!done) throw IoError(path.string() + ": " + first_line(output->geterror()));
    };
    require(output->set_ioproxy(&stream) && output->open(path.string(), spec));
    for (int y = 0; y < spec.height; ++y) {
      read(y, row.data());
      require(output->write_scanline(y, 0, spec.format, row.data()));
    }
    require(output->close());
  });
}

void write_bytes(const fs::path& path, const std::vector<unsigned char>& data) {
  write_atomically(path, {reinterpret_cast<const char*>(data.data()), data.size()});
}

void set_pitch(ImageSpec& spec, double pitch_mm_x, double pitch_mm_y) {
  if (!(pitch_mm_x > 0) || !(pitch_mm_y > 0)) return;
  spec.attribute("ResolutionUnit", "in");  // OpenEXR knows no other unit.
  spec.attribute("XResolution", static_cast<float>(k_mm_per_inch / pitch_mm_x));
  spec.attribute("YResolution", static_cast<float>(k_mm_per_inch / pitch_mm_y));
  spec.attribute("PixelAspectRatio", static_cast<float>(pitch_mm_x / pitch_mm_y));
}

void check_pixels(int width, int height, std::size_t values, std::size_t channels, const char* function) {
  if (width < 1 || height < 1 || values != channels * pixel_count(width, height))
    throw InvalidInput(fmt::format("{}: {} values for a picture of {} x {}", function, values, width, height));
}

std::vector<std::byte> to_bytes(const std::vector<unsigned char>& data) {
  const auto bytes = std::as_bytes(std::span(data));
  return {bytes.begin(), bytes.end()};
}

}  // namespace

GreyImage read_grey_image(const fs::path& path, std::size_t bytes_per_pixel) {
  ImageBands bands(path, k_max_image_pixels);
  bands.require_memory(bytes_per_pixel);
  return bands.next(bands.height());
}

ColorImage read_color_image(const fs::path& path, std::size_t bytes_per_pixel) {
  PictureInput input(path, k_max_image_pixels);
  return input.is_float() ? read_picture(path, bytes_per_pixel + sizeof(float)).color
                          : read_rgb(input, bytes_per_pixel);
}

Picture read_picture(const fs::path& path, std::size_t bytes_per_pixel) {
  ImageBands bands(path, k_max_image_pixels, std::numeric_limits<int>::max());
  bands.require_memory(bytes_per_pixel);
  GreyImage grey = bands.next(bands.height());
  return {std::move(grey), bands.sample(), bands.bits(), 1};
}

Picture read_reduced_picture(const fs::path& path, int most_side, std::size_t bytes_per_pixel) {
  ImageBands bands(path, k_max_streamed_pixels, most_side);
  const int n = (std::max(bands.width(), bands.height()) - 1) / most_side + 1;
  GreyImage grey{(bands.width() + n - 1) / n, (bands.height() + n - 1) / n, {},
                 n * bands.pitch_mm(),        n > 1 ? 32 : bands.bits(),    bands.curve()};
  bands.require_memory(bytes_per_pixel, pixel_count(grey.width, grey.height));
  for (int row = 0; row < grey.height; ++row) {
    const GreyImage band = bands.next(n);
    for (int column = 0; column < grey.width; ++column) {
      const int left = column * n, right = std::min(left + n, band.width);
      double sum = 0;
      for (int y = 0; y < band.height; ++y)
        for (int x = left; x < right; ++x) sum += static_cast<double>(band.at(x, y));
      grey.pixels.push_back(static_cast<float>(sum / ((right - left) * band.height)));
    }
  }
  return {std::move(grey), bands.sample(), bands.bits(), n};
}

Picture read_fitting_picture(const fs::path& path, std::size_t bytes_per_pixel) {
  ImageBands bands(path);
  const double width = bands.width(), height = bands.height();
  const double bytes = static_cast<double>(bytes_per_pixel) * width * height;
  const double n = std::ceil(std::sqrt(bytes / static_cast<double>(picture_memory())));
  if (n > 1) {
    // One less a side than would just fit: picture_memory() is also for what the reader holds.
    const int most_side = std::max(1, static_cast<int>(std::max(width, height) / n) - 1);
    Picture reduced = read_reduced_picture(path, most_side, bytes_per_pixel);
    reduced.color = {};
    return reduced;
  }
  bands.require_memory(bytes_per_pixel);
  return {bands.next(bands.height()), {}, bands.bits(), 1};
}

ColorImage decode_color_image(std::span<const std::byte> bytes, const std::string& name) {
  PictureInput input(bytes, name, k_max_image_pixels);
  return read_rgb(input, 3);
}

ColorImage decode_image(const Scene& scene, std::size_t image) {
  const EncodedImage& encoded = scene.images[image];
  const std::string& named = encoded.name.empty() ? encoded.uri : encoded.name;
  return decode_color_image(encoded.bytes, named.empty() ? fmt::format("picture {} of the scene", image) : named);
}

std::vector<std::byte> encode_png(const ColorImage& image) {
  check_pixels(image.width, image.height, image.pixels.size(), 3, "encode_png");
  const ImageSpec spec(image.width, image.height, 3, TypeDesc::UINT8);
  return to_bytes(encode("picture.png", spec, TypeDesc::UINT8, image.pixels.data()));
}

EncodedHeight encode_height_png16(const HeightMap& map) {
  check_pixels(map.width, map.height, map.mm.size(), 1, "encode_height_png16");
  if (!std::all_of(map.mm.begin(), map.mm.end(), [](float h) { return std::isfinite(h); }))
    throw InvalidInput("encode_height_png16: a height is not finite");
  const auto [low, high] = std::minmax_element(map.mm.begin(), map.mm.end());
  EncodedHeight result;
  result.offset_mm = double{*low};
  result.scale_mm = double{*high} - double{*low};
  const double steps_per_mm = result.scale_mm > 0 ? 65535 / result.scale_mm : 0;
  std::vector<std::uint16_t> samples(map.mm.size());
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = static_cast<std::uint16_t>(std::lround((double{map.mm[i]} - result.offset_mm) * steps_per_mm));
  const ImageSpec spec(map.width, map.height, 1, TypeDesc::UINT16);
  result.png = to_bytes(encode("height.png", spec, TypeDesc::UINT16, samples.data()));
  return result;
}

void write_grey_image(const fs::path& path, const GreyImage& image, int bits, int jpeg_quality) {
  check_pixels(image.width, image.height, image.pixels.size(), 1, "write_grey_image");
  if (bits != 8 && bits != 16 && bits != 32)
    throw InvalidInput(fmt::format("write_grey_image: bits = {} is not 8, 16 or 32", bits));
  const TypeDesc type = bits == 8 ? TypeDesc::UINT8 : bits == 16 ? TypeDesc::UINT16 : TypeDesc::FLOAT;
  ImageSpec spec(image.width, image.height, 1, type);
  set_pitch(spec, image.pitch_mm, image.pitch_mm);
  if (path.extension() == ".jpg" || path.extension() == ".jpeg")
    spec.attribute("Compression", fmt::format("jpeg:{}", jpeg_quality));
  if (image.curve.size() >= 2 && path.extension() != ".exr") {
    const std::vector<std::byte> profile = io_detail::profile_of_curve(image.curve);
    spec.attribute("ICCProfile", TypeDesc(TypeDesc::UINT8, static_cast<int>(profile.size())), profile.data());
  }
  write_bytes(path, encode(path, spec, TypeDesc::FLOAT, image.pixels.data()));
}

void write_height_float(const fs::path& path, const HeightMap& map) {
  check_pixels(map.width, map.height, map.mm.size(), 1, "write_height_float");
  ImageSpec spec(map.width, map.height, 1, TypeDesc::FLOAT);
  set_pitch(spec, map.pitch_mm_x, map.pitch_mm_y);
  write_bytes(path, encode(path, spec, TypeDesc::FLOAT, map.mm.data()));
}

void write_height_rows(const fs::path& path, const SampleRows& heights_mm, double depth_mm, double pitch_mm) {
  const int width = heights_mm.width();
  ImageSpec spec(width, heights_mm.height(), 1, TypeDesc::FLOAT);
  if (path.extension() != ".png") {
    set_pitch(spec, pitch_mm, pitch_mm);
    write_rows<float>(path, spec, [&](int y, float* row) { heights_mm.read(0, y, width, row); });
    return;
  }
  spec.set_format(TypeDesc::UINT16);
  std::vector<float> heights(static_cast<std::size_t>(width));
  const double steps_per_mm = depth_mm > 0 ? 65535 / depth_mm : 0;
  write_rows<std::uint16_t>(path, spec, [&](int y, std::uint16_t* row) {
    heights_mm.read(0, y, width, heights.data());
    for (const float height : heights)
      *row++ = static_cast<std::uint16_t>(std::lround(std::clamp(double{height} * steps_per_mm, 0.0, 65535.0)));
  });
}

void write_color_image(const fs::path& path, const ColorImage& image) {
  check_pixels(image.width, image.height, image.pixels.size(), 3, "write_color_image");
  const ImageSpec spec(image.width, image.height, 3, TypeDesc::UINT8);
  write_bytes(path, encode(path, spec, TypeDesc::UINT8, image.pixels.data()));
}

}  // namespace papilla
