// SPDX-License-Identifier: MIT
#include "papilla/pipeline/photograph_file.hpp"

#include <algorithm>
#include <cstddef>

#include "papilla/io/image_file.hpp"
#include "papilla/texture/tiling.hpp"

namespace papilla {

PhotographFile photograph_of_relief_file(const std::filesystem::path& relief, const std::filesystem::path& output,
                                         const PhotographFileOptions& options) {
  constexpr std::size_t k_bytes_per_pixel = 64;  // The picture, its brightness, albedo and their transforms.
  constexpr double k_unknown_pitch_mm = 0.1;
  constexpr int k_float_bits = 32, k_picture_bits = 8;
  const GreyImage heights = read_grey_image(relief, k_bytes_per_pixel);
  PhotographFile result;
  result.pitch_mm = options.pitch_mm > 0   ? options.pitch_mm
                    : heights.pitch_mm > 0 ? heights.pitch_mm
                                           : k_unknown_pitch_mm;
  HeightMap map{heights.width,   heights.height,  heights.pixels,
                result.pitch_mm, result.pitch_mm, measure_tiling(heights).tiles};
  if (heights.bits < k_float_bits)
    for (float& height : map.mm) height *= static_cast<float>(options.height_mm);
  const auto [low, high] = std::minmax_element(map.mm.begin(), map.mm.end());
  result.range_mm = static_cast<double>(*high) - static_cast<double>(*low);
  const bool linear = output.extension() == ".exr";
  PhotographOptions photograph_options = options.photograph;
  if (linear) photograph_options.srgb = false, photograph_options.bits = k_float_bits;
  result.photograph = photograph(map, photograph_options);
  write_grey_image(output, result.photograph.picture, linear ? k_float_bits : k_picture_bits, options.jpeg_quality);
  return result;
}

}  // namespace papilla
