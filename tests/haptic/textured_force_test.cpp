// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "haptic/textured_force.hpp"

namespace papilla {
namespace {

TEST(TexturedForce, SineIsWithinOnePercent) {
  EXPECT_LT(testing::force_error(testing::sine_relief(), 1024, 0.2, 1000).rms_share, 0.01);
}

TEST(TexturedForce, SpheresAreWithinOnePercent) {
  EXPECT_LT(testing::force_error(testing::sphere_relief(), 1024, 0.2, 1000).rms_share, 0.01);
}

TEST(TexturedForce, CoarseMapIsWorse) {
  EXPECT_GT(testing::force_error(testing::sine_relief(), 64, 0.2, 500).rms_share,
            3 * testing::force_error(testing::sine_relief(), 1024, 0.2, 500).rms_share);
}

TEST(CoulombFriction, ForcesAreStaticThenDynamic) {
  ContactMaterial material;
  material.stiffness = 500;
  material.static_friction = 0.5;
  material.dynamic_friction = 0.3;
  const ContactSurface surface(testing::plate(10, 10, 0.1, 0.1), {material}, {}, 0);
  Proxy proxy(surface);
  proxy.reset({0.02, 0.05, 0.001});
  double largest = 0;
  for (int i = 0; i < 250; ++i) {
    const Vec3 probe{0.02 + 2e-4 * i, 0.05, -1e-3};
    const Vec3 force = heightfield_force(surface, proxy.update(probe, 1e-3), probe, {});
    largest = std::max(largest, -force.x / force.z);
    if (i > 20) {
      EXPECT_NEAR(-force.x, 0.3 * force.z, 0.01 * 0.3 * force.z) << i;
    }
  }
  // It sticks until the static limit, to the step of a tick.
  EXPECT_NEAR(largest, 0.5, 2e-4 / 1e-3);
}

}  // namespace
}  // namespace papilla
