// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "papilla/core/vec.hpp"

namespace papilla {

/// A rigid motion x ↦ R x + t.
struct Pose {
  std::array<Vec3, 3> rows{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};  ///< Of R.
  Vec3 shift;                                                             ///< t, m.

  Vec3 turned(Vec3 v) const noexcept { return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}; }
  Vec3 turned_back(Vec3 v) const noexcept { return v.x * rows[0] + v.y * rows[1] + v.z * rows[2]; }
  Vec3 operator()(Vec3 p) const noexcept { return turned(p) + shift; }
};

/// Where a real part stands.
struct Registration {
  Pose to_part;           ///< From the frame of the device to that of the part.
  double residual_m = 0;  ///< Root mean square distance of the touched points from those of the part.
};

/// The rigid motion that takes three touched points nearest to three of the part, in the sense of least squares: the
/// planes of both triangles laid upon each other, their centroids too, turned in that plane by
///     atan2(Σ n·(a_i × b_i), Σ a_i·b_i),
/// which is the whole solution for points of a plane (Kabsch 1976, A solution for the best rotation to relate two sets
/// of vectors).
/// @throws InvalidInput when a point is not finite, or the points of a set are on a line: a triangle less high than
/// 5 mm.
Registration register_points(const std::array<Vec3, 3>& touched, const std::array<Vec3, 3>& of_part);

/// The motion that lays a touched plane upon one of the part: the first point on `point`, the way to the second one
/// along `along`, and the normal towards which the three points turn counter-clockwise on `normal`.
/// @throws InvalidInput as register_points(), or when `along` is along `normal`.
Registration register_plane(const std::array<Vec3, 3>& touched, Vec3 point, Vec3 normal, Vec3 along);

}  // namespace papilla
