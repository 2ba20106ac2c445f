// SPDX-License-Identifier: MIT
#include "papilla/io/image_bands.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "picture_input.hpp"

namespace papilla {
namespace {

constexpr int k_rows_at_once = 64;
/// Tiles whose row holds more values than this are refused: a gigabyte.
constexpr std::size_t k_most_values = std::size_t{1} << 28;

}  // namespace

struct ImageBands::State {
  std::filesystem::path path;
  std::unique_ptr<OIIO::ImageInput> input;
  int width, height, channels, rows_at_once, stride;
  int decoded = 0;             ///< Rows.
  std::vector<float> waiting;  ///< Grey rows decoded and not yet returned by next().
  std::vector<float> stored;   ///< Scratch: rows as the file stores them.
  ColorImage sample;

  State(const std::filesystem::path& file, std::size_t most_pixels, int sample_side)
      : path(file), input(io_detail::open_picture(file, most_pixels)) {
    const OIIO::ImageSpec& spec = input->spec();
    width = spec.width;
    height = spec.height;
    channels = io_detail::color_channels(spec);
    rows_at_once = std::min(height, spec.tile_height > 0 ? spec.tile_height : k_rows_at_once);
    stride = static_cast<int>((std::int64_t{std::max(width, height)} + sample_side - 1) / sample_side);
    sample.width = (width + stride - 1) / stride;
    if (io_detail::pixel_count(width, rows_at_once) * static_cast<std::size_t>(channels) > k_most_values)
      throw InvalidInput(fmt::format("{}: rows of {} x {} pixels are too large to be read at once", path.string(),
                                     width, rows_at_once));
  }

  void decode() {
    const OIIO::ImageSpec& spec = input->spec();
    const int rows = std::min(rows_at_once, height - decoded), top = spec.y + decoded;
    stored.resize(io_detail::pixel_count(width, rows) * static_cast<std::size_t>(channels));
    const bool read =
        spec.tile_height > 0
            ? input->read_tiles(0, 0, spec.x, spec.x + width, top, top + rows, spec.z, spec.z + 1, 0, channels,
                                OIIO::TypeDesc::FLOAT, stored.data())
            : input->read_scanlines(0, 0, top, top + rows, spec.z, 0, channels, OIIO::TypeDesc::FLOAT, stored.data());
    if (!read) throw InvalidInput(path.string() + ": is damaged: " + first_line(input->geterror()));
    for (int y = 0; y < rows; ++y)
      if ((decoded + y) % stride == 0) take_sample(y);
    const std::size_t first = waiting.size(), count = io_detail::pixel_count(width, rows);
    for (std::size_t i = 0; i < count; ++i)
      waiting.push_back(channels == 3
                            ? 0.2126F * stored[3 * i] + 0.7152F * stored[3 * i + 1] + 0.0722F * stored[3 * i + 2]
                            : stored[i]);
    const auto bad = std::find_if(waiting.begin() + static_cast<std::ptrdiff_t>(first), waiting.end(),
                                  [](float v) { return !std::isfinite(v); });
    if (bad != waiting.end()) {
      const auto before = io_detail::pixel_count(width, decoded);
      throw InvalidInput(fmt::format("{}: pixel {} is not finite", path.string(),
                                     before + static_cast<std::size_t>(bad - waiting.begin()) - first));
    }
    decoded += rows;
  }

  void take_sample(int row) {
    for (int x = 0; x < width; x += stride)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t channel = channels == 3 ? c : 0;
        const float value = stored[io_detail::pixel_count(width, row) * static_cast<std::size_t>(channels) +
                                   static_cast<std::size_t>(x) * static_cast<std::size_t>(channels) + channel];
        const float grey = std::isfinite(value) ? std::clamp(value, 0.0F, 1.0F) : 0;
        sample.pixels.push_back(static_cast<unsigned char>(std::lround(255 * grey)));
      }
    ++sample.height;
  }
};

ImageBands::ImageBands(const std::filesystem::path& path, std::size_t most_pixels, int sample_side)
    : state_(std::make_unique<State>(path, most_pixels, sample_side)) {}
ImageBands::~ImageBands() = default;

int ImageBands::width() const noexcept { return state_->width; }
int ImageBands::height() const noexcept { return state_->height; }
int ImageBands::bits() const noexcept { return static_cast<int>(8 * state_->input->spec().format.basesize()); }
double ImageBands::pitch_mm() const noexcept { return io_detail::pitch_of(state_->input->spec()); }
const ColorImage& ImageBands::sample() const noexcept { return state_->sample; }

GreyImage ImageBands::next(int rows) {
  std::vector<float>& waiting = state_->waiting;
  const auto columns = static_cast<std::size_t>(state_->width);
  const int left = state_->height - state_->decoded + static_cast<int>(waiting.size() / columns);
  const int taken = std::clamp(rows, 0, left);
  const std::size_t wanted = io_detail::pixel_count(state_->width, taken);
  waiting.reserve(wanted + io_detail::pixel_count(state_->width, state_->rows_at_once));
  while (waiting.size() < wanted) state_->decode();
  GreyImage band{state_->width, taken, {}, pitch_mm(), bits()};
  std::vector<float> rest(waiting.begin() + static_cast<std::ptrdiff_t>(wanted), waiting.end());
  waiting.resize(wanted);
  band.pixels = std::exchange(waiting, std::move(rest));
  return band;
}

}  // namespace papilla
