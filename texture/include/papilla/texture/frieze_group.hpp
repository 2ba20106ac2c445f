// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// The seven groups of a strip along x: translations alone, with glides, with mirrors across the strip, with half
/// turns, with glides, mirrors across and half turns, with a mirror along the strip, with all.
enum class FriezeGroup { p1, p11g, p1m1, p2, p2mg, p11m, p2mm };

/// The short name, for example "p2mg".
std::string_view to_string(FriezeGroup group) noexcept;

/// What find_frieze_group() returns.
struct FriezeSymmetry {
  bool found = false;  ///< The strip repeats.
  FriezeGroup group = FriezeGroup::p1;
  int order = 1;                    ///< Operations of the group without its translations.
  double period_px = 0;             ///< Along x, 0 when not found.
  double kept = 0;                  ///< Share of the mean cell's variance that averaging over the group keeps.
  double origin_x = 0;              ///< A mirror across the strip, or a centre of half turns.
  double axis_y = 0;                ///< The strip's axis: the row that mirrors along it, glides and half turns keep.
  std::array<Vec2, 4> region_px{};  ///< Smallest generating region: a rectangle of 1/order of the strip's cell.
  std::string reason;               ///< One sentence.
};

/// Symmetry of a strip that repeats along x: the period from the row dy = 0 of the feature matrix, fitted to all its
/// multiples; then, on the mean cell, the group by the criterion of find_wallpaper_group(), with the axis searched
/// among the middle half of the rows and the origin over the period. Good input: a strip cut out along its direction,
/// four periods or more. Stripes repeat whatever runs along them is. Cost: that of the feature matrix, and O(period ·
/// rows²). Deterministic.
/// @throws InvalidInput when the picture is empty or not finite.
/// Schulze 2005, section 7.1.
FriezeSymmetry find_frieze_group(const GreyImage& strip);

/// What find_rosette_group() returns.
struct RosetteSymmetry {
  int rotations = 1;     ///< n: turns by 360°/n keep the picture.
  bool mirrors = false;  ///< Dihedral group Dn instead of Cn.
  double kept = 1;       ///< Share of the variance along circles that averaging over the group keeps.
  Vec2 centre_px{};
  double mirror_deg = 0;  ///< Direction of a mirror line, from x (right) towards y (down); 0 without mirrors.
  double sector_deg =
      360;  ///< Angle of the smallest generating region, a sector: 360°/n, or half of that with mirrors.

  std::string name() const { return (mirrors ? "d" : "c") + std::to_string(rotations); }
};

/// Symmetry of a single motif about a point: the picture is read along circles around it, up to the nearest border, and
/// of Cn and Dn, n = 1…12, the one with the least criterion of find_wallpaper_group() is taken, with the centre moved
/// from `centre_px`, at most 0.15 of the shorter side, to where that group keeps most. The criterion weighs what a
/// group leaves against the picture's pixel noise, estimated from its second differences, so that noise of the motif's
/// own deviation hides neither the order nor the mirrors. Good input: a motif of 32 pixels or more, its centre known to
/// a tenth of its size. Cost: about 0.1 s at 128². Deterministic.
/// @throws InvalidInput when the picture is smaller than 16 pixels a side, or not finite, or the centre is outside.
/// Schulze 2005, section 7.1.
RosetteSymmetry find_rosette_group(const GreyImage& motif, Vec2 centre_px);

}  // namespace papilla
