// SPDX-License-Identifier: MIT
#include "papilla/pipeline/prepare_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "papilla/io/image_file.hpp"
#include "papilla/texture/even_light.hpp"
#include "papilla/texture/resample.hpp"

namespace papilla {
namespace {

GreyImage scale_to_width(const GreyImage& image, int width, bool periodic) {
  const int height =
      std::max(1, static_cast<int>(std::lround(static_cast<double>(width) * image.height / image.width)));
  HeightMap map{image.width, image.height, image.pixels, 1, 1, periodic};
  map = resample(map, width, height);
  GreyImage result{width, height, std::move(map.mm), image.pitch_mm * image.width / width, 32};
  for (float& grey : result.pixels) grey = std::clamp(grey, 0.0F, 1.0F);
  return result;
}

}  // namespace

PreparedPicture prepare_picture_file(const std::filesystem::path& picture, const std::filesystem::path& output,
                                     const PrepareFileOptions& options) {
  constexpr std::size_t k_bytes_per_pixel = 64;  // Of the picture and what prepare_picture() makes of it, at most.
  GreyImage image = read_grey_image(picture, k_bytes_per_pixel);
  if (options.pitch_mm > 0) image.pitch_mm = options.pitch_mm;
  PreparedPicture prepared = prepare_picture(image, options.prepare);
  if (options.width_px) {
    prepared.image = scale_to_width(prepared.image, *options.width_px, prepared.after.tiling.tiles);
    prepared.after = measure_picture(prepared.image);
    prepared.steps.push_back({"scale", true, "asked for"});
  }
  prepared.image.curve = transfer_curve(Transfer::automatic, image.bits, image.curve).linear;
  write_grey_image(output, prepared.image, 16);
  return prepared;
}

}  // namespace papilla
