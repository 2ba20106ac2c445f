// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "papilla/core/bounds.hpp"
#include "placed_bvh.hpp"

namespace papilla::detail {

/// A free place with surfaces around it.
struct Place {
  Vec3 point;
  double enclosure = 0;     ///< Share of the directions in which a surface lies.
  double clearance_mm = 0;  ///< To the nearest surface.
  /// 0 where half of the directions are free, or most of what is seen shows its back: the inside of a solid.
  double score = 0;
};

/// Which way a triangle shows its front.
enum class Facing : std::uint8_t { as_is, turned, unknown };

/// Places spread over the scene's box. Surfaces whose facing is unknown show no back.
/// Cost: 512 places with 64 rays each, about 1 us a ray. Parallel, deterministic.
/// @param facing of each of them; empty: all as they are.
std::vector<Place> look_for_places(const PlacedBvh& bvh, const Bounds3& bounds, std::span<const Facing> facing);

/// The place with the highest score above 0.
std::optional<Place> best_place(const std::vector<Place>& places);

/// Up to `most` places around that see `point` and have at least half the score of the best of them, or of `point`
/// itself where it is one of the places and better.
std::vector<Vec3> places_around(const PlacedBvh& bvh, const std::vector<Place>& places, const Vec3& point,
                                std::size_t most);

/// Directions spread evenly over the sphere, each with its opposite. @param count even.
std::vector<Vec3> directions_around(std::size_t count);

}  // namespace papilla::detail
