// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/texture/height_map.hpp"

namespace papilla {

/// How differently a found relief feels from the true one of the same size: a ball of the default radius is pressed
/// 0.5 mm below the mean height of a plate of 500 N/m without friction and moved over it along four straight strokes of
/// 20 mm/s; rms difference of the forces over the range of the true relief's normal force, in percent. The found
/// heights are scaled and moved to fit best. Every tick is that of the haptic loop. @pre both finite, the truth not
/// flat.
double felt_error_percent(const HeightMap& found, const HeightMap& truth);

}  // namespace papilla
