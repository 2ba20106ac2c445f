// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// Heights in pixels, as photometric_stereo() returns them.
struct PixelRelief {
  int width = 0, height = 0;
  const std::vector<double>& heights;
};

/// A profile measured along a line: height_mm over along_mm, along_mm rising.
struct ProfileLine {
  std::vector<double> along_mm, height_mm;
};

/// Millimetres per pixel of a ruler between two points of the picture: ruler_mm / |to − from|.
/// @throws InvalidInput when the points are less than a pixel apart or the length is not positive.
double pitch_of_ruler(double ruler_mm, Vec2 from_px, Vec2 to_px);

/// Millimetres per pixel of a printed square or hexagonal grid with lines `grid_mm` apart that fills the picture: the
/// lattice's shorter vector is one grid. @throws InvalidInput when the picture has no lattice.
double pitch_of_grid(const GreyImage& picture, double grid_mm);

/// Millimetres of height per unit of the relief, from a step of known height between a low and a high place, each the
/// mean of 5 × 5 pixels. @throws InvalidInput when a place is outside the relief, or the high one is not above the low
/// one.
double scale_of_step(const PixelRelief& relief, double step_mm, Vec2 low_px, Vec2 high_px);

/// A profile against the relief.
struct ProfileFit {
  double scale = 0;        ///< Millimetres of height per unit of the relief; negative when the relief is inside out.
  double correlation = 0;  ///< Of the two lines, their trends removed.
  double rms_mm = 0;       ///< Of what is left.
};

/// The scale by which the relief along a line fits a profile best, next to a shift in height and a tilt: least squares
/// of profile(t) = scale · relief(from + t (to − from)) + a + b t. The profile covers the line from end to end.
/// @throws InvalidInput when an end is outside the relief, the profile has fewer than three points, is not rising or
/// not
///         finite, or one of them is straight.
ProfileFit fit_profile(const PixelRelief& relief, const ProfileLine& profile, Vec2 from_px, Vec2 to_px);

/// Height in millimetres of an edge over the level ground that its shadow falls on: length · tan(elevation).
/// @param edge_px,end_px  the edge and the end of its shadow. @throws InvalidInput when the light does not come from
/// the front.
double height_of_shadow(Vec2 edge_px, Vec2 end_px, Vec3 light, double pitch_mm);

}  // namespace papilla
