// SPDX-License-Identifier: MIT
#include "papilla/param/grain_frame.hpp"

namespace papilla {
namespace {

/// The axis table for z up; the axes are z-up names.
ProjectionAxes z_up_axes(int axis, bool negative) {
  switch (axis) {
    case 0: return {1, 2, negative ? -1.0 : 1.0, 1};
    case 1: return {0, 2, negative ? 1.0 : -1.0, 1};
    default: return {0, 1, 1, negative ? -1.0 : 1.0};
  }
}

}  // namespace

ProjectionAxes projection_axes(int axis, bool negative, UpAxis up) {
  if (up == UpAxis::z) return z_up_axes(axis, negative);
  // Z up named (X, Y, Z) is (x, -z, y) of y up: rename the axes and carry the sign of Y along.
  constexpr int to_z_up[3] = {0, 2, 1};
  const int z_up_axis = to_z_up[axis];
  ProjectionAxes axes = z_up_axes(z_up_axis, z_up_axis == 1 ? !negative : negative);
  if (axes.u_axis == 1) axes.u_sign = -axes.u_sign;
  if (axes.v_axis == 1) axes.v_sign = -axes.v_sign;
  axes.u_axis = to_z_up[axes.u_axis];
  axes.v_axis = to_z_up[axes.v_axis];
  return axes;
}

Vec3 grain_direction(Vec3 normal, UpAxis up) {
  const Vec3 up_direction = up == UpAxis::z ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
  const Vec3 forward = up == UpAxis::z ? Vec3{0, 1, 0} : Vec3{0, 0, -1};
  const double slope = dot(up_direction, normal);
  const Vec3 wanted = up_direction + slope * forward;
  return wanted - dot(wanted, normal) * normal;
}

}  // namespace papilla
