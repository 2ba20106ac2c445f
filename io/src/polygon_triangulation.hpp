// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "papilla/core/vec.hpp"

namespace papilla {

/// Corners beyond which a concave polygon is refused: ear clipping is quadratic and worse.
inline constexpr std::size_t k_max_concave_corners = 8192;

/// Cuts a polygon in space into n − 2 triangles of its corner numbers, in the polygon's winding: a fan when it is
/// convex seen along its normal (Newell's), ears otherwise. A polygon that crosses itself still gives n − 2 triangles.
/// @pre corners.size() >= 3, finite.
/// @throws InvalidInput when a concave polygon has more than k_max_concave_corners corners.
/// Source: Meisters, "Polygons have ears", American Mathematical Monthly 82 (1975).
std::vector<std::array<std::size_t, 3>> triangulate_polygon(std::span<const Vec3> corners);

}  // namespace papilla
