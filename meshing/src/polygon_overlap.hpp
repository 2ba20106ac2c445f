// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include "papilla/core/vec.hpp"

namespace papilla::detail {

/// Does a closed polygon, counter-clockwise where simple, lie over itself? True when two of its edges cross deeper than
/// 1e-5 of the root of its area, or rows through it show more than a thousandth of the area covered again or backwards.
/// Edges may touch, as the two sides of a slit do. O(n) for edges of similar lengths.
bool overlaps_itself(std::span<const Vec2> polygon);

/// Two edges, by the index of their starts, that cross deeper than 1e-5 of the root of the area: of all such pairs the
/// one that lies farthest apart along the polygon, counted in edges.
std::optional<std::pair<std::size_t, std::size_t>> widest_crossing(std::span<const Vec2> polygon);

/// Signed, counter-clockwise positive.
double polygon_area(std::span<const Vec2> polygon);

/// Area over that of the convex hull: 1 for convex polygons, small for sprawling ones; 0 without area.
double compactness(std::span<const Vec2> polygon);

}  // namespace papilla::detail
