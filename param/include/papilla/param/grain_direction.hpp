// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/param/edge_loop.hpp"
#include "papilla/param/flattening.hpp"

namespace papilla {

/// The direction in which a part is longest: the principal axis of its surface,
///     the d of length 1 for which Σ ∫ ((p - c)·d)² dA is greatest, c the surface's middle,
/// with its largest component positive. A part without area, or as long in every direction, has z. O(n), deterministic.
/// @throws InvalidInput when a position is not finite or an index is out of range.
Vec3 longest_direction(const TriangleMesh& mesh);

/// Turns every chart in the plane so that v grows along `direction`, as its projection to the surface runs on the area
/// average: v then means the same direction of space in all charts, and align_phase() can continue the grain from one
/// to the next. Charts that lie across the direction (the mean is below 5 % of what it can be) stay as they are.
/// Nothing is scaled or mirrored. O(n), deterministic.
/// @param flattening of this mesh.
/// @return its uv, turned.
/// @throws InvalidInput when the flattening does not fit the mesh, or the direction is not finite or has no length.
CornerAttribute<Vec2> turn_to_grain(const TriangleMesh& mesh, const Flattening& flattening, Vec3 direction);

/// The same with the direction that the loop has nearest to each triangle's middle. Charts around which the loop runs
/// have no mean direction and stay as they are. O(triangles · points).
/// @throws as above; InvalidInput for a loop of fewer than two points.
CornerAttribute<Vec2> turn_to_grain(const TriangleMesh& mesh, const Flattening& flattening, const EdgeLoop& loop);

}  // namespace papilla
