// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/texture/height_map.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// A height map shaded as a matt surface, lit from the top left at 35°. Relief with an rms slope below 0.25 is
/// exaggerated to it; `exaggeration` returns the factor.
ColorImage draw_relief(const HeightMap& map, double& exaggeration);

/// Draws a scale bar into the lower left corner and returns its length: the longest of 1, 2 or 5 times a power of ten
/// millimetres that fits into a third of the picture's width. 0, and no bar, in pictures below 48 pixels a side.
double draw_scale_bar(ColorImage& picture, double pitch_mm);

}  // namespace papilla
