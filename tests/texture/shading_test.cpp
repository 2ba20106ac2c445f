// SPDX-License-Identifier: MIT
#include "papilla/texture/shading.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "papilla/core/error.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

TEST(Shading, TiltedPlaneHasLambertsCosine) {
  HeightMap plane = test::make_relief(9, 7, 0.5, [](int x, int y) { return 0.5 * (0.3 * x - 0.2 * y); });
  plane.periodic = false;
  const Vec3 light = normalized(Vec3{-0.4, 0.1, 0.9});
  const GreyImage picture = render_lambert(plane, Vec3{-0.8, 0.2, 1.8});  // Any length.
  const double expected = dot(normalized(Vec3{-0.3, 0.2, 1}), light);
  for (const float grey : picture.pixels) EXPECT_NEAR(grey, expected, 1e-6);
  EXPECT_EQ(picture.pitch_mm, 0.5);
}

TEST(Shading, FacesTurnedAwayAreBlack) {
  HeightMap steep = test::make_relief(5, 5, 1, [](int x, int) { return 10.0 * x; });
  steep.periodic = false;
  for (const float grey : render_lambert(steep, {1, 0, 0.2}).pixels) EXPECT_EQ(grey, 0);
}

TEST(Shading, RefusesLightFromBehindAndReliefsWithoutPitch) {
  const HeightMap flat = test::make_relief(3, 3, 1, [](int, int) { return 0.0; });
  EXPECT_THROW(render_lambert(flat, {1, 0, 0}), InvalidInput);
  EXPECT_THROW(render_lambert(flat, {0, 0, 0}), InvalidInput);
  EXPECT_THROW(render_lambert(flat, {0, std::nan(""), 1}), InvalidInput);
  EXPECT_THROW(render_lambert(test::make_relief(3, 3, 0, [](int, int) { return 0.0; }), {0, 0, 1}), InvalidInput);
}

}  // namespace
}  // namespace papilla
