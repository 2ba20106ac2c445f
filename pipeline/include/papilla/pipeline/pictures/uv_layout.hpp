// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "papilla/meshing/triangle_mesh.hpp"
#include "papilla/param/measure.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

struct UvLayoutOptions {
  int side_px = 1024;  ///< Longer side of the drawing, legend excluded; 64 to 8192.
  int samples = 3;     ///< Samples per pixel and axis; 1 to 8.
  double worst = 5;    ///< Symmetric Dirichlet distortion at the end of the scale; above 4.
};

/// An sRGB colour, 0 to 255.
using Rgb = std::array<unsigned char, 3>;

/// The colour of a triangle by its symmetric Dirichlet distortion, as in draw_uv_layout().
Rgb distortion_colour(const TriangleDistortion& distortion, double worst);

/// Draws the triangles in the plane, v upwards, each in the colour of its symmetric Dirichlet distortion on a scale
/// from 4 (isometry, dark blue) to `worst` and more (yellow), with even steps of lightness for every kind of colour
/// vision (viridis). Flipped and degenerate triangles are red, chart borders black. The legend below has the scale with
/// its numbers. Triangles without uv are left out.
/// @param report of measure_distortion() with this uv.
ColorImage draw_uv_layout(const CornerAttribute<Vec2>& uv, const DistortionReport& report,
                          const UvLayoutOptions& options = {});

}  // namespace papilla
