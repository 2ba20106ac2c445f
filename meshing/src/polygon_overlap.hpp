// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "papilla/core/vec.hpp"

namespace papilla::detail {

/// The area that a closed polygon, counter-clockwise where simple, covers more than once or backwards, as a fraction of
/// its area: sampled on rows of its bounding box, exact along the row. Zero for polygons without area.
/// O(n + crossings log crossings).
double overlap_fraction(std::span<const Vec2> polygon);

}  // namespace papilla::detail
