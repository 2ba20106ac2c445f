// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "rest_shape.hpp"

namespace papilla::param_detail {

/// A triangle of a vertex: the edge opposite to the vertex, and the shape of (vertex, from, to).
struct RingEdge {
  Vec2 from, to;
  RestShape rest;
};

/// The middle of all places that see every edge of the ring from the left.
/// @param closed_by_chord  and the line from the end of the last edge to the start of the first one.
/// @return whether there are any.
bool middle_of_kernel(std::span<const RingEdge> ring, bool closed_by_chord, Vec2& middle);

}  // namespace papilla::param_detail
