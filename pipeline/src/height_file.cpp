// SPDX-License-Identifier: MIT
#include "papilla/pipeline/height_file.hpp"

#include <string_view>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/normal_map.hpp"
#include "pictures/relief.hpp"
#include "pictures/texture_plots.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

/// NAME-suffix.EXT beside NAME.EXT.
fs::path beside(const fs::path& file, const std::string& suffix) {
  return file.parent_path() / (file.stem().string() + "-" + suffix + file.extension().string());
}

std::vector<DeeperRelief> write_deeper(const fs::path& output, const HeightMap& map) {
  std::vector<DeeperRelief> files;
  for (const int factor : {2, 4}) {
    HeightMap deeper = map;
    for (float& height : deeper.mm) height *= static_cast<float>(factor);
    files.push_back({factor, beside(output, "x" + std::to_string(factor)).string()});
    write_height_file(files.back().file, deeper);
  }
  return files;
}

std::vector<ReliefPicture> draw_pictures(const fs::path& folder, HeightMap map) {
  make_folder(folder);
  const std::string section = (folder / "section.svg").string();
  const bool has_section = write_plot(section, section_plot(map));
  const double pitch_mm = map.pitch_mm_x;
  if (!(pitch_mm > 0)) map.pitch_mm_x = map.pitch_mm_y = 1;  // Any value: draw_relief() scales the slopes.
  std::vector<ReliefPicture> pictures;
  const auto draw = [&](const char* name, const HeightMap& relief) {
    double exaggeration = 1;
    ColorImage picture = draw_relief(relief, exaggeration);
    const double bar_mm = draw_scale_bar(picture, pitch_mm);
    pictures.push_back({name, (folder / (std::string(name) + ".png")).string(), true, exaggeration, bar_mm});
    write_color_image(pictures.back().file, picture);
  };
  draw("relief", map);
  draw("relief-opposite", opposite_relief(map));
  pictures.push_back({"section", section, has_section, {}, 0});
  return pictures;
}

}  // namespace

void write_height_file(const fs::path& path, const HeightMap& map) {
  if (path.extension() != ".png") {
    write_height_float(path, map);
    return;
  }
  const EncodedHeight encoded = encode_height_png16(map);
  write_atomically(path, std::string_view(reinterpret_cast<const char*>(encoded.png.data()), encoded.png.size()));
}

HeightFiles height_of_picture_file(const fs::path& picture, const fs::path& output, const HeightFileOptions& options) {
  HeightFiles files{height_from_image(read_grey_image(picture), options.height), {}, {}, {}};
  const HeightMap& map = files.result.map;
  write_height_file(output, map);
  if (!options.normal_map.empty()) write_color_image(options.normal_map, normal_map(map));
  if (options.opposite) {
    files.opposite = beside(output, "opposite").string();
    write_height_file(files.opposite, opposite_relief(map));
  }
  if (options.deeper) files.deeper = write_deeper(output, map);
  if (!options.pictures.empty()) files.pictures = draw_pictures(options.pictures, map);
  return files;
}

}  // namespace papilla
