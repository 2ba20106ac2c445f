// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>

#include "rest_shape.hpp"

namespace papilla::param_detail {

/// A triangle of a vertex that comes back into a map: the edge opposite to the vertex, and the shape of
/// (vertex, from, to).
struct RingEdge {
  Vec2 from, to;
  RestShape rest;
};

/// Finds a place where all triangles of the ring are positive and, as far as one vertex can do, their symmetric
/// Dirichlet energy is low.
/// @param ring edges in order, the last one ending where the first one starts when the vertex is not on the border.
/// @param allowed may refuse places; empty: none. For a vertex on the border it must not refuse the polygon of the
/// ring.
/// @return false when rounding leaves no such place.
bool place_in_ring(std::span<const RingEdge> ring, const std::function<bool(Vec2)>& allowed, Vec2& place);

}  // namespace papilla::param_detail
