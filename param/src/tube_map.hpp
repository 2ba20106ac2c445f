// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "map_descent.hpp"
#include "map_level.hpp"

namespace papilla::param_detail {

/// Whether the disk has one end that is far from its border, and no other one.
bool has_one_end(const MapLevel& level, std::span<const Vec3> positions);

/// A map around a pole, and its rings.
struct TubeMap {
  std::vector<Vec2> uv;  ///< The pole at the origin.
  RingScales rings;
};

/// A map for disks that are one tube with a closed end, or a bag: the deepest vertex becomes the pole; what remains, a
/// surface between two closed curves, goes to the wall of a cylinder by harmonic weights, the end free to turn against
/// the border; a ring's radius in the plane is that of a circle of the area inside it. Where Tutte's map on a disk
/// shrinks a tube by a factor per diameter, this one has about the size of least energy.
/// @return nothing where the pole has no ring of its own or a triangle is not positive.
std::optional<TubeMap> map_tube(const MapLevel& level, std::span<const Vec3> positions);

}  // namespace papilla::param_detail
