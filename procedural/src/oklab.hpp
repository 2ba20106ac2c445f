// SPDX-License-Identifier: MIT
#pragma once

#include "colours.hpp"

namespace papilla::procedural_detail {

/// A colour by what eyes tell apart: equal steps look about equally large.
/// "A perceptual color space for image processing", B. Ottosson, 2020, in cylindrical coordinates.
struct Oklch {
  double lightness = 0;  ///< In [0, 1].
  double chroma = 0;     ///< 0 is grey; at most 0.33 in sRGB.
  double hue = 0;        ///< In radians.
};

/// @param srgb  coded, each in [0, 1].
Oklch oklch_of(const Rgb& srgb);

/// The coded colour of the same hue and lightness, with as much of the chroma as sRGB has; lightness is clamped.
Rgb srgb_of(Oklch colour);

}  // namespace papilla::procedural_detail
