// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/texture/image.hpp"
#include "papilla/texture/sample_rows.hpp"

namespace papilla {

/// How visible the seam is when a picture is laid edge to edge; see measure_tiling().
struct Tiling {
  bool tiles = false;             ///< Both seams are at most as strong as the strongest step inside the picture.
  double seam_x = 0, seam_y = 0;  ///< Mean |step| across the left-right and the top-bottom seam, relative to that step.
};

/// Compares the mean absolute grey step from the last column to the first one with the strongest mean step between
/// any two neighbouring columns, and the same for rows. A picture that is one pixel wide tiles in x.
/// Cost: O(pixels). @throws InvalidInput when the picture is empty or not finite.
Tiling measure_tiling(const GreyImage& image);
/// The same of finite samples, in one pass.
Tiling measure_tiling(const SampleRows& picture);

}  // namespace papilla
