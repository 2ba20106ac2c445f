// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "map_level.hpp"

namespace papilla::param_detail {

/// Tutte's map of a small disk, holes filled by fans: the longest border goes to a circle of the disk's area, edges
/// along it in proportion to their length as far as that leaves none too short. Weights are uniform on disks that are
/// less deep than wide; on deeper ones, edges that lead away from the border weigh more. Valid for every triangulated
/// disk without double edges, up to rounding.
std::vector<Vec2> map_to_circle(const MapLevel& level, std::span<const Vec3> positions);

}  // namespace papilla::param_detail
