// SPDX-License-Identifier: MIT
#include "papilla/param/grain_frame.hpp"

#include <gtest/gtest.h>

namespace papilla {
namespace {

Vec3 unit(int axis, double sign) { return {axis == 0 ? sign : 0, axis == 1 ? sign : 0, axis == 2 ? sign : 0}; }

TEST(GrainFrame, ProjectionsAreNeverMirrored) {
  for (const UpAxis up : {UpAxis::y, UpAxis::z})
    for (int axis = 0; axis < 3; ++axis)
      for (const bool negative : {false, true}) {
        const ProjectionAxes p = projection_axes(axis, negative, up);
        EXPECT_EQ(cross(unit(p.u_axis, p.u_sign), unit(p.v_axis, p.v_sign)), unit(axis, negative ? -1 : 1));
      }
}

TEST(GrainFrame, GrainStandsUprightOnTheWalls) {
  for (const bool negative : {false, true}) {
    for (const int axis : {0, 1}) {
      const ProjectionAxes p = projection_axes(axis, negative, UpAxis::z);
      EXPECT_EQ(unit(p.v_axis, p.v_sign), (Vec3{0, 0, 1}));
    }
    for (const int axis : {0, 2}) {
      const ProjectionAxes p = projection_axes(axis, negative, UpAxis::y);
      EXPECT_EQ(unit(p.v_axis, p.v_sign), (Vec3{0, 1, 0}));
    }
  }
}

TEST(GrainFrame, DirectionAgreesWithTheProjectionsOnTheAxes) {
  for (const UpAxis up : {UpAxis::y, UpAxis::z})
    for (int axis = 0; axis < 3; ++axis)
      for (const bool negative : {false, true}) {
        const ProjectionAxes p = projection_axes(axis, negative, up);
        const Vec3 d = grain_direction(unit(axis, negative ? -1 : 1), up);
        EXPECT_NEAR(norm(d - unit(p.v_axis, p.v_sign)), 0, 1e-15);
      }
}

TEST(GrainFrame, DirectionIsTangential) {
  const Vec3 n = normalized({0.3, -0.5, 0.7});
  EXPECT_NEAR(dot(grain_direction(n, UpAxis::z), n), 0, 1e-15);
  EXPECT_NEAR(dot(grain_direction(n, UpAxis::y), n), 0, 1e-15);
}

}  // namespace
}  // namespace papilla
