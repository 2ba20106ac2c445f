// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "papilla/core/vec.hpp"
#include "papilla/texture/image.hpp"
#include "papilla/texture/wallpaper_group.hpp"

namespace papilla::test {

/// A random picture of a known wallpaper group on a known lattice.
struct WallpaperPattern {
  WallpaperGroup group = WallpaperGroup::p1;
  Vec2 a, b;  ///< Primitive vectors, pixels, not whole numbers.
  GreyImage image;
};

/// `side` × `side` pixels, 8 bits: a sum of waves whose amplitudes are random and fall with the wave number, averaged
/// over the operations of the group as the International Tables list them, at a random rotation and origin, with cells
/// of 22 to 44 pixels (conventional cell, longest side up to 66) and normal noise of `noise` times the standard
/// deviation of the signal. p1 and p2 have oblique and rectangular cells in turns. Drawn again while the
/// pattern repeats on a finer lattice, or is symmetric under a further operation, up to 6 % of its variance.
WallpaperPattern wallpaper_pattern(WallpaperGroup group, std::uint64_t seed, double noise, int side);

/// What a camera and a real material do to a pattern; see photographed_pattern().
struct PhotoConditions {
  double warp = 0.05;      ///< Rms of each component of the displacement, as a share of the root of the cell's area.
  double warp_length = 2;  ///< Length of its correlation exp(−r² / (2 length²)), in the same unit.
  double falloff = 0.3;    ///< Share of the light that the darkest place lacks.
  double blur_px = 0.8;    ///< Standard deviation of the point spread.
  double noise = 0.04;     ///< Standard deviation as a share of the full range of greys.
  int quality = 85;        ///< Of JPEG.
};
inline constexpr PhotoConditions k_bent_photo{}, k_badly_bent_photo{0.1, 2, 0.5, 1.0, 0.06, 75};

/// wallpaper_pattern() with its points displaced by a smooth field, under light that falls off along a line or around a
/// point, blurred, with normal noise, rounded to 8 bits and quantized as JPEG does. The vectors are those
/// of the mean cell: the linear part of the displacement is counted as theirs.
WallpaperPattern photographed_pattern(WallpaperGroup group, std::uint64_t seed, const PhotoConditions& photo, int side);

/// Distance of two vectors from the nearest true lattice vectors, the larger one; 1e9 when they span another lattice.
double lattice_error(const std::array<Vec2, 2>& found, Vec2 a, Vec2 b);

}  // namespace papilla::test
