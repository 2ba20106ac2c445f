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

/// Distance of two vectors from the nearest true lattice vectors, the larger one; 1e9 when they span another lattice.
double lattice_error(const std::array<Vec2, 2>& found, Vec2 a, Vec2 b);

}  // namespace papilla::test
