// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/core/up_axis.hpp"
#include "papilla/core/vec.hpp"

namespace papilla {

/// How a coordinate plane is laid into texture space: u = u_sign * p[u_axis], v = v_sign * p[v_axis].
struct ProjectionAxes {
  int u_axis = 0, v_axis = 1;
  double u_sign = 1, v_sign = 1;
};

/// The projection along a coordinate axis under which grain stands upright and is never mirrored seen from
/// outside: v is the up axis on the four walls; on top and bottom v goes on in the direction in which it
/// runs up the wall that faces the viewer (-y when z is up, +z when y is up).
/// u × v is the outward axis: `axis`, or its opposite when `negative`.
/// @param axis 0, 1 or 2.
ProjectionAxes projection_axes(int axis, bool negative, UpAxis up);

/// The direction in the surface along which v should grow at a point with this outward normal: the same rule
/// as projection_axes(), continued over all directions: t = up - (up·n) n + (up·n) forward, made tangential.
/// It has length 1 on the six axes and is zero only where the rule leaves no preference.
/// @param normal of length 1.
Vec3 grain_direction(Vec3 normal, UpAxis up);

}  // namespace papilla
