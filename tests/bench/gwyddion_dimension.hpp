// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/texture/image.hpp"

namespace papilla::bench {

/// Fractal dimension by Gwyddion's most accurate library function on Brownian surfaces, the partitioning (variance)
/// method, over all its scales as its dialog does by default.
double gwyddion_partitioning_dimension(const GreyImage& image);

}  // namespace papilla::bench
