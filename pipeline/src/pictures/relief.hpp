// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/texture/height_map.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// A height map lit from the top left under 35°, true to scale: what the eye would see of the relief on a matt surface.
/// Relief too flat to be seen is exaggerated until its rms slope is 0.25; `exaggeration` returns the factor.
ColorImage draw_relief(const HeightMap& map, double& exaggeration);

/// Draws a white bar in a black frame into the lower left corner and returns its length: the longest of 1, 2 or 5 times
/// a power of ten millimetres that fits into a third of the picture's width. 0, and no bar, in pictures below 48 pixels
/// a side.
double draw_scale_bar(ColorImage& picture, double pitch_mm);

}  // namespace papilla
