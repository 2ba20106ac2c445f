// SPDX-License-Identifier: GPL-3.0-or-later
#include "page/page_report.hpp"

#include <algorithm>

#include "page/page_file.hpp"
#include "papilla/core/base64.hpp"
#include "papilla/io/image_file.hpp"

namespace papilla::app {
namespace {

/// Longer side of a photograph on a card.
constexpr int k_photo_px = 256;

/// The picture with whole pixels averaged, so that its longer side is at most `side` pixels.
ColorImage shrink(const ColorImage& image, int side) {
  const int factor = (std::max(image.width, image.height) + side - 1) / side;
  if (factor <= 1) return image;
  ColorImage small;
  small.width = std::max(1, image.width / factor);
  small.height = std::max(1, image.height / factor);
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x)
      for (int c = 0; c < 3; ++c) {
        int sum = 0, count = 0;
        for (int j = y * factor; j < std::min((y + 1) * factor, image.height); ++j)
          for (int i = x * factor; i < std::min((x + 1) * factor, image.width); ++i, ++count)
            sum += image.pixels[3 * (static_cast<std::size_t>(j) * static_cast<std::size_t>(image.width) +
                                     static_cast<std::size_t>(i)) +
                                static_cast<std::size_t>(c)];
        small.pixels.push_back(static_cast<unsigned char>(sum / std::max(count, 1)));
      }
  return small;
}

}  // namespace

void write_report_page(const std::filesystem::path& glb, Json report, const std::map<std::string, Grain>& grains,
                       const std::filesystem::path& page, const PageSceneOptions& options,
                       const ProgressCallback& progress) {
  for (Json& material : report["materials"]) {
    const ColorImage& photograph = grains.at(material["name"].get<std::string>()).photograph;
    material["photo"] = encode_base64(encode_png(shrink(photograph, k_photo_px)));
  }
  PageSceneOptions shown = options;
  const Scene scene = read_for_page(glb, {}, shown.levels);
  write_page({glb.filename().string(), page_scene(scene, glb, shown, progress).json, std::move(report)}, page);
}

}  // namespace papilla::app
