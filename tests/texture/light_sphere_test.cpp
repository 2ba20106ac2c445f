// SPDX-License-Identifier: MIT
#include "papilla/texture/light_sphere.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "papilla/core/error.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

constexpr double k_radius = 30;
constexpr Vec2 k_centre{52, 41};

/// A ball whose pixel with the normal n has the brightness grey(n), on a dark ground.
GreyImage ball(const std::function<double(Vec3)>& grey) {
  return test::make_image(110, 84, [&](int x, int y) {
    const double dx = (x - k_centre.x) / k_radius, dy = (y - k_centre.y) / k_radius, square = dx * dx + dy * dy;
    return square < 1 ? grey({dx, dy, std::sqrt(1 - square)}) : 0.05;
  });
}

TEST(LightSphere, MattBallWithAmbientLight) {
  for (const Vec3 light : {Vec3{0.5, -0.4, 0.7}, Vec3{-0.8, 0.1, 0.5}, Vec3{0, 0, 1}}) {
    const Vec3 unit = normalized(light);
    const GreyImage picture = ball([&](Vec3 n) { return 0.1 + 0.7 * std::max(0.0, dot(n, unit)); });
    EXPECT_GT(dot(light_of_sphere(picture, {k_centre, k_radius, false}), unit), std::cos(0.03));
  }
}

TEST(LightSphere, MirrorBall) {
  const Vec3 unit = normalized({0.5, -0.4, 0.7});
  const Vec3 half = normalized(unit + Vec3{0, 0, 1});
  const GreyImage picture = ball([&](Vec3 n) { return 0.02 + std::pow(std::max(0.0, dot(n, half)), 400); });
  EXPECT_GT(dot(light_of_sphere(picture, {k_centre, k_radius, true}), unit), std::cos(0.03));
}

TEST(LightSphere, RefusesBallsThatAreNotThere) {
  const GreyImage black = test::make_image(110, 84, [](int, int) { return 0.0; });
  EXPECT_THROW(light_of_sphere(black, {k_centre, k_radius, false}), InvalidInput);
  EXPECT_THROW(light_of_sphere(black, {{10, 41}, k_radius, false}), InvalidInput);
  EXPECT_THROW(light_of_sphere(black, {k_centre, 2, false}), InvalidInput);
}

}  // namespace
}  // namespace papilla
