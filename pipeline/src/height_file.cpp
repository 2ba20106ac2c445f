// SPDX-License-Identifier: MIT
#include "papilla/pipeline/height_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/image_bands.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/normal_map.hpp"
#include "papilla/texture/texture_reading.hpp"
#include "pictures/relief.hpp"
#include "pictures/texture_plots.hpp"
#include "relief_files.hpp"

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

bool needs_memory(const HeightFileOptions& options) {
  return options.by_class || options.height.tile || options.height.roughness != HeightRoughness::whole ||
         options.height.shortest_wavelength_mm > 0 || !options.normal_map.empty() || !options.pictures.empty();
}

HeightFiles height_by_bands(ImageBands& bands, const fs::path& output, const HeightFileOptions& options) {
  constexpr int k_rows = 64;
  // A device has no room beside it.
  const bool is_device = fs::exists(output) && !fs::is_regular_file(output);
  const fs::path folder = is_device ? fs::temp_directory_path() : output.parent_path();
  SampleFile grey(bands.width(), bands.height(), folder);
  for (int y = 0; y < bands.height();) {
    const GreyImage band = bands.next(k_rows);
    for (int row = 0; row < band.height; ++row, ++y)
      grey.write(y, std::span(band.pixels).subspan(band.index(0, row), static_cast<std::size_t>(band.width)));
  }
  HeightOptions height = options.height;
  if (!(height.pitch_mm > 0)) height.pitch_mm = bands.pitch_mm();
  SampleFile samples(bands.width(), bands.height(), folder);
  const TransferCurve curve = transfer_curve(height.transfer, bands.bits(), bands.curve());
  const HeightRows rows = height_from_rows(grey, curve, height, samples);
  HeightFiles files{rows.result, {}, {}, {}, {}, {}};
  const auto write = [&](const fs::path& file, double factor, double offset_mm) {
    const ScaledSamples heights(samples, factor * rows.scale, rows.lowest, offset_mm);
    write_height_rows(file, heights, std::abs(factor) * rows.result.depth_mm, rows.result.map.pitch_mm_x);
    return file.string();
  };
  write(output, 1, 0);
  if (options.opposite) files.opposite = write(beside(output, "opposite"), -1, rows.result.depth_mm);
  if (options.deeper)
    for (const int factor : {2, 4})
      files.deeper.push_back({factor, write(beside(output, "x" + std::to_string(factor)), factor, 0)});
  return files;
}

void take_by_class(const GreyImage& image, const HeightFileOptions& options, HeightFiles& files) {
  ReadingOptions reading;
  reading.progress = options.height.progress;
  PictureReliefOptions relief = *options.by_class;
  relief.height = options.height;
  PictureRelief made = relief_of_picture(image, read_texture(image, reading), relief);
  files.result = std::move(made.height);
  files.plan = std::move(made.plan);
  files.roughness = made.roughness;
}

}  // namespace

Transfer transfer_of_file(Transfer wanted, const Picture& picture) {
  const bool is_mean = picture.pixels_a_side > 1;
  if (wanted != Transfer::automatic || !is_mean || !picture.grey.curve.empty()) return wanted;
  return transfer_curve(wanted, picture.file_bits).source == CurveSource::srgb ? Transfer::srgb : Transfer::linear;
}

void write_height_file(const fs::path& path, const HeightMap& map) {
  if (path.extension() != ".png") {
    write_height_float(path, map);
    return;
  }
  const EncodedHeight encoded = encode_height_png16(map);
  write_atomically(path, std::string_view(reinterpret_cast<const char*>(encoded.png.data()), encoded.png.size()));
}

HeightFiles height_of_picture_file(const fs::path& picture, const fs::path& output, const HeightFileOptions& options) {
  if (!needs_memory(options)) {
    ImageBands bands(picture);
    if (std::max(bands.width(), bands.height()) > options.largest_px) return height_by_bands(bands, output, options);
  }
  const Picture read = read_fitting_picture(picture, k_height_bytes_per_pixel);
  HeightFileOptions own = options;
  own.height.pitch_mm *= read.pixels_a_side;
  own.height.transfer = transfer_of_file(options.height.transfer, read);
  HeightFiles files;
  if (options.by_class)
    take_by_class(read.grey, own, files);
  else
    files.result = height_from_image(read.grey, own.height);
  if (read.pixels_a_side > 1)
    files.result.assumed.push_back(
        fmt::format("nothing finer than {0} pixels matters: the picture was read as means over {0} x {0}, for which "
                    "there is memory (--max-memory)",
                    read.pixels_a_side));
  write_relief_files(files, output, options);
  return files;
}

void write_relief_files(HeightFiles& files, const fs::path& output, const HeightFileOptions& options) {
  const HeightMap& map = files.result.map;
  write_height_file(output, map);
  if (!options.normal_map.empty()) write_color_image(options.normal_map, normal_map(map));
  if (options.opposite) {
    files.opposite = beside(output, "opposite").string();
    write_height_file(files.opposite, opposite_relief(map));
  }
  if (options.deeper) files.deeper = write_deeper(output, map);
  if (!options.pictures.empty()) files.pictures = draw_pictures(options.pictures, map);
}

}  // namespace papilla
