// SPDX-License-Identifier: MIT
#include "haptic/reference_descent.hpp"

#include <gtest/gtest.h>

#include "haptic/contact_shapes.hpp"
#include "papilla/haptic/proxy.hpp"

namespace papilla {
namespace {

TEST(ReferenceDescent, RestsAboveTheGoalOnAPlateAndInACorner) {
  const double skin = 2e-5;
  const ContactMesh plate = testing::plate(20, 20, 0.1, 0.1), corner = testing::box({0, 0, 0}, {0.1, 0.1, 0.1});
  testing::ReferenceDescent on_plate(plate, skin), in_corner(corner, skin);
  EXPECT_LT(on_plate.gap({0.05, 0.05, skin}, {0.051, 0.0502, -1e-3}, {0.051, 0.0502, skin}), 1e-8);
  EXPECT_LT(in_corner.gap({0.0005, 0.0005, 0.0005}, {-1e-3, -2e-3, -1e-3}, {skin, skin, skin}), 1e-8);
  EXPECT_GT(on_plate.gap({0.05, 0.05, skin}, {0.051, 0.05, -1e-3}, {0.05, 0.05, skin}), 9e-4);
  EXPECT_LT(norm(on_plate.nearest({0.03, 0.04, -2e-3}) - Vec3{0.03, 0.04, 0}), 1e-12);
}

TEST(ReferenceDescent, UnderARimEitherSideIsRight) {
  const double skin = 2e-5;
  const ContactMesh plate = testing::plate(20, 20, 0.1, 0.1);
  testing::ReferenceDescent reference(plate, skin);
  const Vec3 from{0.0998, 0.05, skin}, on_rim{0.1, 0.05, skin};
  const Vec3 outside{0.1 + 1e-6, 0.05, -1e-3}, inside{0.0995, 0.05, -1e-3};
  EXPECT_GT(reference.gap(from, outside, on_rim), 9e-4);
  EXPECT_LT(reference.gap_shifted(from, outside, on_rim, 1.25e-6), 1e-5);
  EXPECT_GT(reference.gap_shifted(from, inside, {0.0993, 0.05, skin}, 1.25e-6), 1.9e-4);
}

TEST(Proxy, IsWhereTheReferenceDescentEnds) {
  const ContactMesh mesh = testing::height_grid(100, 100, 0.06, 0.06, testing::rough_relief);
  const ContactSurface surface(mesh, {ContactMaterial{}}, {}, 0);
  testing::ReferenceDescent reference(mesh, surface.skin_m());
  testing::Wanderer wanderer(3, 0.06, 0.008, 2e-4);
  Proxy proxy(surface);
  proxy.reset({0.03, 0.03, 0.02});
  Vec3 last{0.03, 0.03, 0.02};
  int far = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec2 p = wanderer.next();
    const Vec3 probe{p.x, p.y, testing::rough_relief(p.x, p.y) - 1.5e-3}, before = proxy.state().proxy;
    const ProxyState& state = proxy.update(probe, 1e-3);
    if (i % 20 == 19) far += reference.gap(before, probe, state.proxy) > 1e-4 + norm(probe - last);
    last = probe;
  }
  EXPECT_EQ(far, 0);
}

}  // namespace
}  // namespace papilla
