// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/texture/image.hpp"
#include "papilla/texture/texture_class.hpp"
#include "papilla/texture/tiling.hpp"

namespace papilla {

/// How borders are matched: not at all, by a cut through an overlap, by mirroring (twice the size); `automatic` cuts
/// pictures that do not tile.
enum class BorderMatching { automatic, none, cut, mirror };

/// The name on the command line: auto, none, cut, mirror.
std::string_view to_string(BorderMatching matching) noexcept;
/// The matching of that name. @throws InvalidInput for any other name.
BorderMatching border_matching(std::string_view name);

/// Options of prepare_picture().
struct PrepareOptions {
  bool straighten = false;  ///< Straightens a lattice that bends; pictures up to 2048 pixels a side.
  bool flatten = true;      ///< Takes gradients of brightness and contrast away.
  double flatten_px = 0;    ///< Waves longer than about six of these are gradients; 0: a tenth of the shorter side, and
                            ///< at least the longer lattice vector.
  double plasticity = 0;    ///< Detail finer than 1 % of the side is raised by this factor, 0 to 4.
  BorderMatching borders = BorderMatching::automatic;
  bool contrast = true;  ///< Stretches the 0.5 to 99.5 percentiles to [0, 1].
  ProgressCallback progress = {};
};

/// What prepare_picture() measures before and after.
struct PictureNumbers {
  int width = 0, height = 0;
  double mean = 0, contrast = 0;  ///< Of the grey values; contrast is their standard deviation.
  double gradient = 0;            ///< Range of the 16 block means over the standard deviation.
  double contrast_ratio = 1;      ///< Of the strongest and the weakest of the 16 block contrasts.
  int knots = 0;  ///< Blocks of an 8 × 8 grid that stand out from the others by more than five robust deviations.
  Tiling tiling;
};

/// What prepare_picture() returns.
struct PreparedPicture {
  GreyImage image;
  PictureNumbers before, after;
  AnalysisPlan steps;                 ///< What was done, in order, and why.
  std::vector<std::string> warnings;  ///< Knots and gradients that show when the result is tiled.
};

/// Prepares a scanned or photographed surface for analysis and tiling, in the source's order:
///   straighten  straightened() by the deformation of its lattice; a rim as wide as the largest displacement is cut off
///   flatten     I ← mean + (I − low) · deviation / local deviation (factor within [½, 2]), low and local deviation by
///   a
///               Gaussian of flatten_px
///   plasticity  I ← I + plasticity · (I − Gaussian of 0.5 % of the side of I)
///   borders     cut: the right quarter of the picture, at most, is laid over the left border; of the overlaps the one
///               that differs least, and in it the path of least difference [Efros and Freeman], over two pixels each
///               side of which the two are mixed; then the same from bottom to top. The result is smaller by the
///               overlap and exactly continuous at its borders. A picture with a lattice loses no period: the overlap
///               fits itself to it. mirror: the picture and its mirror images.
///   contrast    percentiles stretched
/// Knots are only reported: what they hide is not in the picture. Colours are for the caller.
/// In pictures over 2048 pixels a side the Gaussians are taken of a smaller copy on which they still span eight pixels,
/// and the overlap is searched from coarse to fine. Cost: O(pixels · log) and the feature matrix; about 0.1 s at 512²;
/// at most 16 bytes a pixel beside the picture. Deterministic.
/// @throws InvalidInput when the picture is smaller than 16 pixels a side, empty or not finite, or an option is out of
/// range.
/// Schulze 2005, section 4.3.2; Efros and Freeman, Image quilting for texture synthesis and transfer, 2001.
PreparedPicture prepare_picture(const GreyImage& image, const PrepareOptions& options = {});

/// See PictureNumbers. Cost: O(pixels). @throws InvalidInput when the picture is empty or not finite.
PictureNumbers measure_picture(const GreyImage& image);

}  // namespace papilla
