// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fuzz_input.hpp"
#include "papilla/io/image_bands.hpp"
#include "papilla/io/image_file.hpp"
#include "png_mutator.hpp"

/// The first byte chooses the extension, by which OpenImageIO chooses the reader that it tries first.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace papilla;
  constexpr std::array k_names = {"input.png", "input.jpg", "input.tif", "input.exr",
                                  "input.bmp", "input.tga", "input.hdr", "input.webp"};
  constexpr std::size_t k_most_pixels = 65536;
  if (size == 0) return 0;
  const auto path = fuzz::write_input(k_names[data[0] % k_names.size()], fuzz::text_of(data + 1, size - 1));
  const bool accepted = fuzz::expect_read([&] {
    ImageBands bands(path, k_most_pixels, std::numeric_limits<int>::max());
    const GreyImage grey = bands.next(bands.height());
    fuzz::require(grey.width > 0 && grey.height > 0, "a picture has pixels");
    fuzz::require(grey.pixels.size() == static_cast<std::size_t>(grey.width) * static_cast<std::size_t>(grey.height),
                  "a value per pixel");
    fuzz::require(std::all_of(grey.pixels.begin(), grey.pixels.end(), [](float v) { return std::isfinite(v); }),
                  "values are finite");
    fuzz::require(bands.sample().pixels.size() == 3 * grey.pixels.size(), "a colour per pixel");
  });
  if (!accepted) return 0;
  fuzz::expect_result_or_refusal([&] { read_color_image(path); });
  fuzz::expect_result_or_refusal([&] { decode_color_image(std::as_bytes(std::span(data + 1, size - 1)), "input"); });
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  using namespace papilla::fuzz;
  Random random(seed);
  const bool png = size > 1 && is_png(text_of(data + 1, size - 1));
  if (!png && random.chance(0.5)) {  // The samples of most formats come last.
    const std::size_t head = size / 2;
    return head + mutate_bytes(data + head, size - head, max_size - head, random);
  }
  if (!png || random.chance(0.1)) return mutate_bytes(data, size, max_size, random);
  std::string bytes(text_of(data + 1, size - 1));
  mutate_png(bytes, random);
  return store(static_cast<char>(data[0]) + bytes, data, size, max_size);
}
