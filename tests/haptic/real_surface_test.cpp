// SPDX-License-Identifier: MIT
#include "player/real_surface.hpp"

#include <gtest/gtest.h>

#include <array>

#include "haptic/contact_shapes.hpp"
#include "papilla/haptic/height_field.hpp"

namespace papilla::player {
namespace {

constexpr double k_radius = 0.002;

/// A plate of 80 × 50 mm in the plane z = 0 with a relief that reaches 0.2 mm below it.
class RealSurfaceTest : public ::testing::Test {
 protected:
  RealSurfaceTest() {
    scene_.mesh = testing::plate(4, 3, 0.08, 0.05);
    scene_.mesh.material.assign(scene_.mesh.triangles.size(), 0);
    scene_.materials.resize(1);
    scene_.materials[0].height = 0;
    HeightFieldOptions options;
    options.scale_m = 3e-4;
    options.offset_m = -2e-4;
    scene_.heights = {HeightField(2, 1, {0, 65535}, options)};
  }
  ContactSurface surface() const { return ContactSurface(scene_.mesh, scene_.materials, scene_.heights, k_radius); }

  HapticScene scene_;
};

TEST_F(RealSurfaceTest, PointsOfAPartAreTouchedOnItsMeshNotAtTheBottomOfItsRelief) {
  const Vec3 shift{0.3, -0.1, 0.2};
  const std::array<Vec3, 3> tips{Vec3{0.01, 0.02, k_radius}, Vec3{0.07, 0.01, k_radius}, Vec3{0.03, 0.045, k_radius}};
  RealSurface real;
  for (const Vec3& tip : tips) {
    const Vec3 touched = tip - shift;
    real.touched.insert(real.touched.end(), {touched.x, touched.y, touched.z});
    real.part_points.insert(real.part_points.end(), {tip.x, tip.y, 0.001});  // Not quite on it.
  }
  const Registration found = register_part(real, scene_, surface());
  EXPECT_LT(found.residual_m, 1e-9);
  for (const Vec3& tip : tips) EXPECT_LT(norm(found.to_part(tip - shift) - tip), 1e-9);
}

TEST_F(RealSurfaceTest, APlaneIsTouchedFirstAtTheMiddleOfTheLargestSurface) {
  RealSurface real;
  real.touched = {0.1, 0.2, 0.3, 0.1, 0.25, 0.3, 0.1, 0.2, 0.36};  // It looks along x.
  const Registration found = register_part(real, scene_, surface());
  EXPECT_LT(norm(found.to_part({0.1, 0.2, 0.3}) - Vec3{0.04, 0.025, k_radius}), 1e-9);
  EXPECT_LT(norm(found.to_part.turned({1, 0, 0}) - Vec3{0, 0, 1}), 1e-9);
  EXPECT_LT(norm(found.to_part.turned({0, 1, 0}) - Vec3{1, 0, 0}), 1e-9);
}

TEST_F(RealSurfaceTest, APlaneThatLooksAlongXHasADirectionToo) {
  for (Vec3& p : scene_.mesh.positions) p = {p.z, p.x, p.y};
  RealSurface real;
  real.touched = {0.1, 0.2, 0.3, 0.1, 0.25, 0.3, 0.1, 0.2, 0.36};
  const Registration found = register_part(real, scene_, surface());
  EXPECT_LT(norm(found.to_part({0.1, 0.2, 0.3}) - Vec3{k_radius, 0.04, 0.025}), 1e-9);
  EXPECT_LT(norm(found.to_part.turned({1, 0, 0}) - Vec3{1, 0, 0}), 1e-9);
  EXPECT_LT(norm(found.to_part.turned({0, 1, 0}) - Vec3{0, 1, 0}), 1e-9);
}

}  // namespace
}  // namespace papilla::player
