// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "papilla/io/image_file.hpp"
#include "papilla/texture/height_from_image.hpp"
#include "papilla/texture/picture_relief.hpp"

namespace papilla {

/// Writes a relief in the format of the extension: 16-bit grey .png (lowest height black, highest white), or
/// 32-bit float .exr, .tif, .tiff in millimetres.
/// @throws InvalidInput for other extensions; IoError when writing fails.
void write_height_file(const std::filesystem::path& path, const HeightMap& map);

/// Memory that height_from_image() takes for a pixel, the picture and its results included, at most.
inline constexpr std::size_t k_height_bytes_per_pixel = 96;

/// The curve of a picture: what is wanted, and for `automatic` that of the file's own samples, where those are means
/// and the file has no profile.
Transfer transfer_of_file(Transfer wanted, const Picture& picture);

/// Options of height_of_picture_file().
struct HeightFileOptions {
  HeightOptions height;
  /// Carry out the plan of the picture's class, as bake does [relief_of_picture()]: these, with `height` for theirs.
  std::optional<PictureReliefOptions> by_class = {};
  std::filesystem::path normal_map;  ///< File for the glTF normal map of the relief; empty: none.
  std::filesystem::path pictures;    ///< Folder for HeightFiles::pictures; empty: none are drawn.
  bool opposite = false;             ///< Write opposite_relief() too, as NAME-opposite.EXT beside the output.
  int largest_px = 4096;             ///< Longer pictures are read in bands, if no option needs the whole of them.
  bool deeper = false;               ///< Write the relief 2 and 4 times as deep too, as NAME-x2.EXT and NAME-x4.EXT.
};

/// A file with the relief at another depth.
struct DeeperRelief {
  int factor;
  std::string file;
};

/// A file that shows the relief.
struct ReliefPicture {
  std::string name, file;
  bool drawn = true;                   ///< False: gnuplot, which draws it, is not installed.
  std::optional<double> exaggeration;  ///< Of the heights in a lit relief.
  double scale_bar_mm = 0;             ///< Length of the scale bar; 0: there is none.
};

/// What height_of_picture_file() computed and the files that it wrote beside the output.
struct HeightFiles {
  HeightResult result;
  std::string opposite;  ///< Empty: not asked for.
  std::vector<DeeperRelief> deeper;
  std::vector<ReliefPicture> pictures;      ///< relief.png and relief-opposite.png, lit; section.svg.
  AnalysisPlan plan;                        ///< What was done by the class, and what was not; empty: not by class.
  std::optional<RoughnessModel> roughness;  ///< To be laid over the relief, which does not hold it; by class.
};

/// Reads a picture of a surface and writes its height_from_image(). One longer than `largest_px` passes through two
/// temporary files of 4 bytes a pixel in the folder of the output (height_from_rows()), unless the class, tile,
/// roughness, a shortest wavelength, a normal map or pictures are asked for: those take k_height_bytes_per_pixel, and
/// where picture_memory() has no room for that, they get the picture by read_fitting_picture(), which `assumed` says.
/// @throws InvalidInput, IoError as read_grey_image(), height_from_image() and write_height_file().
HeightFiles height_of_picture_file(const std::filesystem::path& picture, const std::filesystem::path& output,
                                   const HeightFileOptions& options);

}  // namespace papilla
