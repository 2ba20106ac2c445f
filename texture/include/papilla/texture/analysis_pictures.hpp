// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/texture/image.hpp"
#include "papilla/texture/symmetry.hpp"

namespace papilla {

/// Five panels side by side, each as large as the analysed picture: the picture with its lattice drawn in, the
/// feature matrix with its minima, the primitive (enlarged, along its own axes), the synthesis, and the difference
/// (grey = 0, same contrast as the picture). Without a lattice the last three panels stay grey.
/// Cost: O(pixels). Deterministic. Schulze 2005, figure 7.7.
ColorImage symmetry_strip(const SymmetryAnalysis& analysis);

/// The picture in grey tones, cut to [0, 1]. @throws InvalidInput when the picture is empty or not finite.
ColorImage to_color_image(const GreyImage& image);

}  // namespace papilla
