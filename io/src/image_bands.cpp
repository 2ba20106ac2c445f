// SPDX-License-Identifier: MIT
#include "papilla/io/image_bands.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "papilla/core/error.hpp"
#include "picture_input.hpp"

namespace papilla {
namespace {

constexpr int k_rows_at_once = 64;
/// Larger floats are no grey value, no luminance and no height in millimetres: the file is damaged or of another kind.
constexpr float k_largest_value = 1e6F;

}  // namespace

struct ImageBands::State {
  io_detail::PictureInput input;
  int width, height, rows_at_once, stride;
  std::size_t channels;
  int decoded = 0;            ///< Rows.
  Values<float> waiting;      ///< Grey rows decoded and not yet returned by next().
  std::vector<float> stored;  ///< Scratch: rows as the file stores them.
  std::vector<float> blocks;  ///< Sums of the sample's current row.
  ColorImage sample;
  std::vector<float> curve;

  State(const std::filesystem::path& file, std::size_t most_pixels, int sample_side)
      : input(file, most_pixels),
        width(input.width()),
        height(input.height()),
        rows_at_once(std::min(height, input.tile_rows() > 0 ? input.tile_rows() : k_rows_at_once)),
        stride(static_cast<int>((std::int64_t{std::max(width, height)} + sample_side - 1) / sample_side)),
        channels(static_cast<std::size_t>(input.channels())),
        curve(input.curve()) {
    sample.width = (width + stride - 1) / stride;
    blocks.assign(3 * static_cast<std::size_t>(sample.width), 0.0F);
    // Stored, waiting, and the grey rows that are returned.
    input.require_memory(io_detail::pixel_count(width, rows_at_once) * (channels + 2) * sizeof(float));
  }

  void decode() {
    const int rows = std::min(rows_at_once, height - decoded);
    const std::size_t count = io_detail::pixel_count(width, rows);
    stored.resize(count * channels);
    input.read(decoded, rows, stored.data());
    if (input.is_float()) check_values();
    for (int y = 0; y < rows; ++y) add_to_sample(y);
    for (std::size_t i = 0; i < count; ++i)
      waiting.push_back(channels == 3
                            ? 0.2126F * stored[3 * i] + 0.7152F * stored[3 * i + 1] + 0.0722F * stored[3 * i + 2]
                            : stored[i]);
    decoded += rows;
  }

  void check_values() const {
    const auto bad =
        std::find_if(stored.begin(), stored.end(), [](float v) { return !(std::abs(v) <= k_largest_value); });
    if (bad == stored.end()) return;
    const std::size_t pixel = static_cast<std::size_t>(bad - stored.begin()) / channels,
                      columns = static_cast<std::size_t>(width);
    throw InvalidInput(fmt::format("{}: pixel ({}, {}) is {}, {}", input.name(), pixel % columns,
                                   static_cast<std::size_t>(decoded) + pixel / columns, *bad,
                                   std::isfinite(*bad) ? "beyond a million" : "not finite"));
  }

  /// Adds a row, the `row`-th of the rows stored, to the blocks of the sample; their last row ends them.
  void add_to_sample(int row) {
    for (int x = 0; x < width; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t pixel = io_detail::pixel_count(width, row) + static_cast<std::size_t>(x);
        blocks[3 * static_cast<std::size_t>(x / stride) + c] += stored[pixel * channels + (channels == 3 ? c : 0)];
      }
    const int y = decoded + row, rows = y % stride + 1;
    if (rows < stride && y + 1 < height) return;
    for (int x = 0; x < sample.width; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        const int columns = std::min(stride, width - x * stride);
        const float mean = blocks[3 * static_cast<std::size_t>(x) + c] / static_cast<float>(columns * rows);
        sample.pixels.push_back(static_cast<unsigned char>(std::lround(255 * std::clamp(mean, 0.0F, 1.0F))));
      }
    std::fill(blocks.begin(), blocks.end(), 0.0F);
    ++sample.height;
  }
};

ImageBands::ImageBands(const std::filesystem::path& path, std::size_t most_pixels, int sample_side)
    : state_(std::make_unique<State>(path, most_pixels, sample_side)) {}
ImageBands::~ImageBands() = default;

int ImageBands::width() const noexcept { return state_->width; }
int ImageBands::height() const noexcept { return state_->height; }
int ImageBands::bits() const noexcept { return state_->input.bits(); }
const std::vector<float>& ImageBands::curve() const noexcept { return state_->curve; }
double ImageBands::pitch_mm() const noexcept { return state_->input.pitch_mm(); }
void ImageBands::require_memory(std::size_t bytes_per_pixel) const {
  require_memory(bytes_per_pixel, io_detail::pixel_count(state_->width, state_->height));
}
void ImageBands::require_memory(std::size_t bytes_per_pixel, std::size_t pixels) const {
  state_->input.require_memory(bytes_per_pixel * pixels);
}
const ColorImage& ImageBands::sample() const noexcept { return state_->sample; }

GreyImage ImageBands::next(int rows) {
  Values<float>& waiting = state_->waiting;
  const auto columns = static_cast<std::size_t>(state_->width);
  const int left = state_->height - state_->decoded + static_cast<int>(waiting.size() / columns);
  const int taken = std::clamp(rows, 0, left);
  const std::size_t wanted = io_detail::pixel_count(state_->width, taken);
  waiting.reserve(wanted + io_detail::pixel_count(state_->width, state_->rows_at_once));
  while (waiting.size() < wanted) state_->decode();
  GreyImage band{state_->width, taken, {}, pitch_mm(), bits(), state_->curve};
  Values<float> rest(waiting.begin() + static_cast<std::ptrdiff_t>(wanted), waiting.end());
  waiting.resize(wanted);
  band.pixels = std::exchange(waiting, std::move(rest));
  return band;
}

}  // namespace papilla
