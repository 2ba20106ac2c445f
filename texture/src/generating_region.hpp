// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "papilla/core/vec.hpp"
#include "plane_groups.hpp"

namespace papilla::texture_detail {

/// The Dirichlet cell of a point in general position under the group of the operations about `origin` (lattice
/// coordinates) and the lattice: the points of the plane that are nearer to it than to any of its images. Its area is
/// that of the lattice cell over the number of operations. Corners in the vectors' unit, in order.
std::vector<Vec2> generating_region(const std::array<Vec2, 2>& vectors, const std::vector<PlaneOperation>& operations,
                                    Vec2 origin);

/// Area of a polygon with its corners in order.
double polygon_area(const std::vector<Vec2>& corners);

}  // namespace papilla::texture_detail
